"""Masking noise of a session as a client of JACK hears it, from a server with the dummy driver."""
import os
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import numpy
from jack_server import RATE_HZ, Recorder, environment_of, running_server, wait_until
from noise_laws import TRIALS, NoiseLaws, answers
from program import session_on


def start_session(server, directory):
    return subprocess.Popen(session_on("plug:jack", directory), stdin=subprocess.PIPE,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                            env=environment_of(server))


def wait_for_outputs(session, recording):
    def connect():
        assert session.poll() is None, session.stdout.read()
        return recording.connect()
    wait_until("the program's outputs", connect)


def gaps(channel):
    """The lengths of silence within, in samples."""
    sounding = numpy.flatnonzero(channel)
    silent = numpy.concatenate(([0], channel[sounding[0]:sounding[-1]] == 0, [0]))
    begins, ends = (numpy.flatnonzero(numpy.diff(silent) == step) for step in (1, -1))
    return ends - begins


def has_gap(channel):
    return (gaps(channel) > 10).any()


def new_directory(test):
    directory = Path(tempfile.mkdtemp(prefix="tapstudy_jack_"))
    test.addClassCleanup(shutil.rmtree, directory)
    return directory


class JackSession(NoiseLaws, unittest.TestCase):
    ATTEMPTS = 5

    @classmethod
    def setUpClass(cls):
        """A busy machine starves a server without real-time priority: its gaps are not ours."""
        server = cls.enterClassContext(running_server())
        for _ in range(cls.ATTEMPTS):
            heard = cls.session_on(server)
            if not has_gap(heard[0]):
                break
        cls.hear(heard, RATE_HZ)

    @classmethod
    def session_on(cls, server):
        recording = Recorder.of(server)
        session = start_session(server, new_directory(cls))
        wait_for_outputs(session, recording)
        said, _ = session.communicate(answers(), timeout=300)
        assert session.returncode == 0, said
        assert "not played" not in said, said
        time.sleep(0.2)
        return recording.heard()

    def test_it_has_no_gap(self):
        self.assertFalse(has_gap(self.channels[0]))

    def test_after_the_last_answer_it_is_silent(self):
        self.assertTrue((self.channels[0][-RATE_HZ // 10:] == 0).all())


class KilledSound(unittest.TestCase):
    """The sound's server is killed in the third trial: no answer is lost, and the store tells."""

    @classmethod
    def setUpClass(cls):
        directory = new_directory(cls)
        with running_server() as server:
            recording = Recorder.of(server)
            session = start_session(server, directory)
            wait_for_outputs(session, recording)
            lines = answers().splitlines(keepends=True)
            session.stdin.write("".join(lines[:2]))
            session.stdin.flush()
            wait_until("two answers", lambda: len(cls.rows(directory, "SELECT 1 FROM response")) == 2)
            recording.client.close()  # a client whose server dies may crash
            server.process.kill()
            time.sleep(1)
            cls.said, _ = session.communicate("".join(lines[2:]), timeout=300)
            cls.status = session.returncode
        cls.stored = cls.rows(directory, "SELECT number, response FROM response JOIN trial USING "
                                         "(trial_id) ORDER BY number")
        cls.events = dict(cls.rows(directory, "SELECT kind, count(DISTINCT number) FROM event JOIN trial "
                                              "USING (trial_id) WHERE kind LIKE 'masking%' GROUP BY kind"))

    @staticmethod
    def rows(directory, query):
        try:
            with sqlite3.connect(f"file:{directory}/study/study.db?mode=ro", uri=True) as database:
                return database.execute(query).fetchall()
        except sqlite3.OperationalError:
            return []

    def test_every_answer_is_there_once_and_in_order(self):
        self.assertEqual(self.status, 0, self.said)
        self.assertEqual([number for number, _ in self.stored], list(range(1, TRIALS + 1)))
        plates = ["acrylic_two", "mdf_two", "acrylic_three", "mdf_three"]
        self.assertEqual([plate for _, plate in self.stored], [plates[trial % 4] for trial in range(TRIALS)])

    def test_the_operator_is_told_and_the_trials_say_it(self):
        self.assertIn("masking noise is no longer played", self.said)
        self.assertEqual((self.events["masking"], self.events["masking_lost"]), (3, 1))


class StarvedCard(unittest.TestCase):
    STALL_S = 0.4  # as in stalling_player
    BUFFER_S = 0.08

    @classmethod
    def setUpClass(cls):
        with running_server() as server:
            recording = Recorder.of(server)
            player = subprocess.Popen([os.environ["TAPSTUDY_STALLING_PLAYER"], "plug:jack"],
                                      stdout=subprocess.PIPE, text=True, env=environment_of(server))
            wait_until("the player's outputs", recording.connect)
            cls.counted = int(player.communicate(timeout=300)[0])
            cls.gaps_s = gaps(recording.heard()[0]) / RATE_HZ

    def test_as_many_underruns_are_counted_as_gaps_are_heard(self):
        self.assertGreaterEqual(self.counted, 3)
        self.assertEqual(self.counted, len(self.gaps_s))

    def test_a_gap_lasts_what_the_stall_exceeds_the_buffer_by(self):
        for gap_s in sorted(self.gaps_s)[-3:]:
            self.assertAlmostEqual(gap_s, self.STALL_S - self.BUFFER_S, delta=0.05)


if __name__ == "__main__":
    unittest.main(argv=sys.argv, verbosity=2)
