"""Sessions at the page whose program is killed, stopped for a moment and cut off at any time; also on a
disk that is full again and again, and on one that fails and can be read only from then on.

TAPSTUDY_KILLS says how many times the program is killed, TAPSTUDY_SEED where the chances begin. An
answer is confirmed on a screen once a later screen's progress counts its trial as done, or once the
program has ended by itself with all trials stored.
"""
import collections
import contextlib
import hashlib
import http.client
import json
import os
import random
import shutil
import signal
import socket
import sqlite3
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path
from urllib.parse import urlparse

from program import PROGRAM, SOURCE, Session

KILLS = int(os.environ.get("TAPSTUDY_KILLS", "40"))
SEED = int(os.environ.get("TAPSTUDY_SEED", "1"))
PROTOCOL = SOURCE / "protocols/paper/discrimination.yaml"
STIMULI = ["acrylic_two", "mdf_two", "acrylic_three", "mdf_three"]
TRIALS = 8
PATIENCE_S = 180  # for one run of the program, which takes seconds
NETWORK = (OSError, http.client.HTTPException)


class MortalSession(Session):
    """Killed after so long, from its first moment on; None: never."""

    def __init__(self, *arguments, life_s, **options):
        self.life_s = life_s
        self.death = None
        super().__init__(*arguments, **options)

    def _address(self, name, patience_s=120):
        if self.death is None:
            self.die_within(self.life_s)
        try:
            return super()._address(name, patience_s)
        except AssertionError:
            if self.was_killed():
                return None
            raise

    def die_within(self, seconds):
        if self.death:
            self.death.cancel()
        self.death = threading.Timer(seconds or 0, self.process.kill)
        if seconds is not None:
            self.death.start()

    def was_killed(self):
        return self.process.poll() == -signal.SIGKILL

    def close(self):
        self.death.cancel()
        if self.death.ident:
            self.death.join()
        super().close()


def post(url, message, chance):
    """The status; raises if it is not known, as where the connection is lost before the reply."""
    connection = http.client.HTTPConnection(url.hostname, url.port, timeout=5)
    try:
        connection.request("POST", url.path + "input", json.dumps(message), {"X-Tapstudy": "1"})
        if chance.random() < 0.05:
            raise ConnectionAbortedError
        return connection.getresponse().status
    finally:
        connection.close()


class Stream:
    """One stream of the participant's page."""

    def __init__(self, url):
        self.connection = socket.create_connection((url.hostname, url.port), timeout=10)
        self.request = f"GET {url.path}events HTTP/1.1\r\nHost: {url.netloc}\r\n\r\n".encode()
        self.received = b""

    def begin(self):
        self.connection.sendall(self.request)

    def next_event(self):
        """(name, data); data is None where it is no screen."""
        while b"\n\n" not in self.received:
            part = self.connection.recv(65536)
            if not part:
                raise OSError("the stream ended")
            self.received += part
        event, self.received = self.received.split(b"\n\n", 1)
        name, _, data = event.partition(b"\ndata: ")
        return (name, json.loads(data)) if name == b"event: screen" else (name, None)

    def close(self):
        self.connection.close()


class Ledger:
    """What was sent, and what was confirmed, of all participants."""

    def __init__(self):
        self.sent = {}  # (participant, trial): [response, confidence], the last ones
        self.confirmed = set()
        self.notes = {}  # text: whether it was acknowledged

    def count_as_done(self, participant, done):
        self.confirmed |= {(participant, number) for number in range(1, done + 1)}


class Participant:
    """Answers what is asked, at random, and loses the connection at times."""

    def __init__(self, name, session, ledger, chance):
        self.name, self.session, self.ledger, self.chance = name, session, ledger, chance
        self.url = urlparse(session.participant)
        self.stream = None
        self.trial = None
        self.taken = 0  # the last screen whose input was taken
        self.input = None
        self.end = time.monotonic() + PATIENCE_S

    def take_part(self):
        """Until the program is gone."""
        while self.session.process.poll() is None:
            if time.monotonic() > self.end:
                raise AssertionError(f"{self.name} is stuck at {self.input}: {self.session.said()}")
            try:
                self.connect()
                screen = self.stream.next_event()[1]
                if self.chance.random() < 0.02:
                    self.disconnect()
                if screen:
                    self.see(screen)
            except NETWORK:
                self.disconnect()
                time.sleep(0.02)
        self.disconnect()

    def connect(self):
        if self.stream is None:
            self.stream = Stream(self.url)
            self.stream.begin()

    def disconnect(self):
        if self.stream:
            self.stream.close()
        self.stream = None

    def see(self, screen):
        progress = screen["progress"]
        if progress:
            self.ledger.count_as_done(self.name, progress["done"])
        if screen["kind"] == "trial":
            self.trial = screen["trial"]["number"]
            if (self.name, self.trial) in self.ledger.confirmed:
                raise AssertionError(f"{self.name} is asked again about trial {self.trial}")
        if screen["number"] == self.taken:
            return  # the stream is new, the screen is not
        if not self.input or self.input["screen"] != screen["number"]:
            self.input = self.input_to(screen)
        if self.input:
            self.deliver()

    def input_to(self, screen):
        """Is written down before it is sent."""
        number = screen["number"]
        if screen["kind"] == "trial":
            if screen["trial"]["notice"]:
                time.sleep(self.chance.uniform(0, 0.1))
            value = self.chance.randrange(len(STIMULI))
            self.ledger.sent[self.name, self.trial] = [STIMULI[value], None]
            return {"screen": number, "action": "answer", "value": str(value + 1)}
        if screen["kind"] == "confidence":
            value = self.chance.randint(1, screen["confidence"]["steps"])
            self.ledger.sent[self.name, self.trial][1] = value
            return {"screen": number, "action": "confidence", "value": value}
        return {"screen": number, "action": "go_on"} if screen["can_go_on"] else None

    def deliver(self):
        """The same input again while it is not known to have arrived, as the page does."""
        status = post(self.url, self.input, self.chance)
        if status == 200:
            self.taken = self.input["screen"]
            if self.session.life_s is not None and self.chance.random() < 0.1:
                self.session.die_within(self.chance.uniform(0.0001, 0.06))
        elif status != 409:  # its screen has gone
            raise AssertionError(f"{self.input} is answered by HTTP {status}")


class Helper(threading.Thread):
    """Acts again and again while the program runs."""

    def __init__(self, session, act):
        super().__init__()
        self.session, self.act = session, act
        self.start()

    def run(self):
        while self.session.process.poll() is None:
            try:
                self.act()
            except NETWORK:
                time.sleep(0.02)


class KillTest(unittest.TestCase):
    endings = (0, -signal.SIGKILL)

    def setUp(self):
        self.directory = Path(tempfile.mkdtemp(prefix="tapstudy_kill_"))
        self.addCleanup(shutil.rmtree, self.directory)
        self.log_directory = self.directory
        self.chance = random.Random(f"{SEED} {self.id()}")
        self.ledger = Ledger()
        self.kills = 0
        self.protocol = PROTOCOL

    def rows(self, query):
        database = sqlite3.connect(f"file:{self.directory}/study/study.db?mode=ro", uri=True)
        try:
            return database.execute(query).fetchall()
        finally:
            database.close()

    def has_begun(self, participant):
        """A program killed early has stored no session that could be resumed."""
        try:
            return (participant,) in self.rows("SELECT participant_id FROM session")
        except sqlite3.OperationalError:
            return False

    def take_part_until_finished(self, participant):
        is_finished = False
        while not is_finished:
            is_finished = self.run_once(participant)
        self.ledger.count_as_done(participant, TRIALS)

    def run_once(self, participant):
        """Whether it was finished; else the program was killed."""
        life_s = self.chance.uniform(0.001, 3) if self.kills < self.most_kills else None
        options = ["--resume"] if self.has_begun(participant) else []
        session = MortalSession(self.protocol, *options, directory=self.directory,
                                log_directory=self.log_directory, participant=participant, life_s=life_s)
        try:
            if session.operator:
                self.live(participant, session)
            status = session.wait()
            if status not in self.endings:
                self.fail(f"{participant}: exit status {status}: {session.said()}")
            self.kills += status == -signal.SIGKILL
            return status == 0
        finally:
            session.close()

    def live(self, participant, session):
        chances = [random.Random(self.chance.random()) for _ in range(3)]
        helpers = [Helper(session, lambda: self.note(urlparse(session.operator), chances[1])),
                   Helper(session, lambda: self.hold_up(session, chances[2])),
                   *self.more_helpers(session)]
        try:
            Participant(participant, session, self.ledger, chances[0]).take_part()
        finally:
            if session.process.poll() is None:
                session.kill()
            for helper in helpers:
                helper.join()

    def more_helpers(self, session):
        return []

    def note(self, operator, chance):
        time.sleep(chance.uniform(0, 0.4))
        text = f"note {len(self.ledger.notes) + 1}"
        self.ledger.notes[text] = False
        self.ledger.notes[text] = post(operator, {"command": "note " + text}, chance) == 200

    def hold_up(self, session, chance):
        time.sleep(chance.uniform(0.1, 3))
        session.process.send_signal(signal.SIGSTOP)
        time.sleep(chance.uniform(0.05, 0.3))
        session.process.send_signal(signal.SIGCONT)

    def check_all_laws(self):
        stored = self.check_answers()
        self.check_order()
        notes = self.check_notes()
        self.check_journal(stored, notes)
        verified = subprocess.run([PROGRAM, "verify", str(self.directory / "study")],
                                  capture_output=True, text=True)
        self.assertEqual(verified.returncode, 0, verified.stdout + verified.stderr)

    def check_answers(self):
        stored = self.rows("SELECT participant_id, number, response, confidence FROM response "
                           "JOIN trial USING (trial_id) JOIN session USING (session_id)")
        times = collections.Counter(row[:2] for row in stored)
        self.assertEqual([trial for trial, count in times.items() if count > 1], [])
        self.assertEqual(set(times), self.ledger.confirmed)
        self.assertEqual({row[:2]: list(row[2:]) for row in stored}, self.ledger.sent)
        answered = self.rows("SELECT participant_id, number FROM trial JOIN session "
                             "USING (session_id) WHERE status = 'answered'")
        self.assertEqual(sorted(answered), sorted(times))
        return stored

    def check_order(self):
        """One plan for each participant, and what was felt is what it says."""
        plans = dict(self.rows("SELECT participant_id, planned_order FROM session"))
        self.assertEqual(sorted(plans.items()), sorted(self.rows(
            "SELECT DISTINCT participant_id, planned_order FROM session")))
        felt = self.rows("SELECT participant_id, number || ' ' || block || ' ' || repetition || "
                         "' ' || stimulus FROM trial JOIN alternative USING (trial_id) "
                         "JOIN session USING (session_id) WHERE status = 'answered' ORDER BY number")
        for participant, plan in plans.items():
            self.assertEqual([line for who, line in felt if who == participant], plan.splitlines())

    def check_notes(self):
        stored = [row[0] for row in self.rows("SELECT detail FROM operator_action WHERE action = 'note'")]
        times = collections.Counter(stored)
        self.assertEqual([note for note, count in times.items() if count > 1], [])
        self.assertEqual([note for note, is_acknowledged in self.ledger.notes.items()
                          if is_acknowledged and note not in times], [])
        self.assertLessEqual(set(times), set(self.ledger.notes))
        return stored

    def check_journal(self, stored, notes):
        chain = ""
        lines = collections.defaultdict(list)
        for text in (self.directory / "study/answers.journal").read_text().splitlines():
            body, said = text.rsplit(',"chain":"', 1)
            chain = hashlib.sha256(f"{chain}{body}}}".encode()).hexdigest()
            self.assertEqual(said, chain + '"}')
            line = json.loads(text)
            lines[line["kind"]].append(line)
        who = {line["session_id"]: line["participant_id"] for line in lines["session"]}
        answers = [(who[line["session_id"]], line["number"], line["response"], line["confidence"])
                   for line in lines["answer"]]
        self.assertEqual(sorted(map(str, answers)), sorted(map(str, stored)))
        self.assertEqual(sorted(line["detail"] for line in lines["operator_action"] if line["action"] == "note"), sorted(notes))

    def kill_and_check(self, most_kills):
        self.most_kills = most_kills
        people = 0
        while self.kills < most_kills or people == 0:
            people += 1
            self.take_part_until_finished(f"P{people:03}")
        self.check_all_laws()
        acknowledged = sum(self.ledger.notes.values())
        print(f"{self.kills} kills, {people} participants, {len(self.ledger.confirmed)} answers, "
              f"{acknowledged} notes acknowledged of {len(self.ledger.notes)}", flush=True)

    def test_identification(self):
        self.kill_and_check(KILLS - KILLS // 2)

    def test_identification_with_confidence(self):
        self.protocol = self.directory / "confidence.yaml"
        key = "    order: shuffle\n"
        self.protocol.write_text(PROTOCOL.read_text().replace(key, key + "    confidence: {steps: 5}\n"))
        self.kill_and_check(KILLS // 2)


STORE_FAILED = 5


def is_done(*command):
    return subprocess.run(command, stderr=subprocess.DEVNULL, check=False).returncode == 0


class FaultyDisk:
    """Beside KillTest: on a disk of its own, where mounts are allowed, with the log elsewhere."""
    endings = (0, -signal.SIGKILL, STORE_FAILED)
    unmount = ["umount"]

    def setUp(self):
        super().setUp()
        self.log_directory = Path(tempfile.mkdtemp(prefix="tapstudy_kill_"))
        self.addCleanup(shutil.rmtree, self.log_directory)
        if not self.is_mounted():
            self.skipTest("no such mounts here")
        self.addCleanup(lambda: subprocess.run([*self.unmount, self.directory], check=True))
        self.faults = 0

    test_identification_with_confidence = None

    def more_helpers(self, session):
        chance = random.Random(self.chance.random())
        return [Helper(session, lambda: self.fault(session, chance))]

    def check_all_laws(self):
        super().check_all_laws()
        self.assertGreater(self.faults, 0)
        print(f"{self.faults} faults of the disk", flush=True)


class FullDiskTest(FaultyDisk, KillTest):
    """A program that finds no space when it starts gives up, later it waits for the operator."""
    unmount = ["umount", "--lazy"]

    def is_mounted(self):
        return is_done("mount", "-t", "tmpfs", "-o", "size=40m", "none", self.directory)

    def fault(self, session, chance):
        """A while later there is space again, and the operator says so."""
        time.sleep(chance.uniform(0.2, 1.5))
        filler = self.directory / "filler"
        try:
            with open(filler, "wb", buffering=0) as file:
                for size in (2 ** 20, 4096):
                    with contextlib.suppress(OSError):
                        while file.write(b"x" * size) == size:
                            pass
            self.faults += 1
            time.sleep(chance.uniform(0.1, 1))
        finally:
            filler.unlink()
        post(urlparse(session.operator), {"command": "resume"}, chance)


class ReadOnlyDiskTest(FaultyDisk, KillTest):
    """ext4 that finds an error takes nothing any more, not even what was written and not synchronised.
    The operator tries again in vain and ends the session; the disk is mounted anew before the next one."""

    def is_mounted(self):
        self.image = self.log_directory / "image"
        if not self.image.exists():
            with open(self.image, "wb") as file:
                file.truncate(64 * 2 ** 20)
            if not is_done("mkfs.ext4", "-q", self.image):
                return False
        if not is_done("mount", "-o", "loop,errors=remount-ro", self.image, self.directory):
            return False
        if os.access(self.trigger(), os.W_OK):
            return True
        subprocess.run([*self.unmount, self.directory], check=True)
        return False

    def trigger(self):
        device = subprocess.run(["findmnt", "--noheadings", "--output", "SOURCE", self.directory],
                                capture_output=True, text=True, check=True).stdout.strip()
        return Path("/sys/fs/ext4", Path(device).name, "trigger_fs_error")

    def run_once(self, participant):
        is_finished = super().run_once(participant)
        end = time.monotonic() + PATIENCE_S
        while not is_done(*self.unmount, self.directory):  # busy for a moment
            self.assertLess(time.monotonic(), end)
            time.sleep(0.1)
        self.assertTrue(self.is_mounted())
        return is_finished

    def fault(self, session, chance):
        time.sleep(chance.uniform(0.5, 4))
        self.trigger().write_text("1")
        self.faults += 1
        for command in ("resume", "end the disk has failed"):
            time.sleep(chance.uniform(0.1, 1))
            post(urlparse(session.operator), {"command": command}, chance)


def with_mounts_of_its_own():
    """Else whoever makes a mount namespace meanwhile keeps the failed disk in use."""
    private = ["unshare", "--mount", "--propagation", "private"]
    if "TAPSTUDY_KILL_TEST_MOUNTS" not in os.environ and is_done(*private, "true"):
        os.environ["TAPSTUDY_KILL_TEST_MOUNTS"] = "yes"
        os.execvp(private[0], [*private, sys.executable, "-B", *sys.argv])


if __name__ == "__main__":
    with_mounts_of_its_own()
    unittest.main(argv=sys.argv, verbosity=2)
