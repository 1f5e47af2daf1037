"""The paper's three studies answered at a pseudo-terminal, which may stop or vanish."""
import contextlib
import os
import pty
import re
import select
import shutil
import signal
import sqlite3
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM = os.environ["TAPSTUDY_PROGRAM"]
PAPER = Path(__file__).resolve().parents[2] / "protocols/paper"
PATIENCE_S = 120
TOO_EARLY_AGAIN_S = 0.5
PROMPT = re.compile(r"^> $", re.M)
CTRL_S, CTRL_Q = "\x13", "\x11"


class Terminal:
    def __init__(self, study, directory, *options):
        self.said = ""
        self.read_to = 0
        self.status = None  # once it has ended
        self.pid, self.descriptor = pty.fork()
        if self.pid == 0:
            os.execv(PROGRAM, [PROGRAM, "run", str(PAPER / study), "--participant", "P01",
                               "--out", str(directory), *options])

    def receive(self, seconds):
        """Whether anything was said; raises OSError once the program has gone."""
        if not select.select([self.descriptor], [], [], seconds)[0]:
            return False
        self.said += os.read(self.descriptor, 65536).decode(errors="replace").replace("\r", "")
        return True

    def wait_for(self, pattern):
        end = time.monotonic() + PATIENCE_S
        while not (found := re.search(pattern, self.said[self.read_to:], re.M)):
            if time.monotonic() > end:
                raise TimeoutError(f"no {pattern}:\n{self.said}")
            self.receive(0.1)
        self.read_to += found.end()
        return found

    def type(self, text):
        os.write(self.descriptor, text.encode())

    def answer(self, text, trial):
        """Again while it is too early; until the next trial, or the end."""
        while True:
            self.type(text + "\n")
            until = time.monotonic() + TOO_EARLY_AGAIN_S
            with contextlib.suppress(OSError):
                while time.monotonic() < until:
                    self.receive(0.05)
            if f"Trial {trial + 1} of " in self.said or self.has_ended():
                return

    def has_ended(self):
        if self.status is None:
            ended, status = os.waitpid(self.pid, os.WNOHANG)
            self.status = os.waitstatus_to_exitcode(status) if ended else None
        return self.status is not None

    def exit_code(self):
        end = time.monotonic() + PATIENCE_S
        while not self.has_ended() and time.monotonic() < end:
            with contextlib.suppress(OSError):
                self.receive(0.1)
        return self.status


class TerminalSessionTest(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp(prefix="tapstudy_terminal_")
        self.addCleanup(shutil.rmtree, self.directory)
        self.study = Path(self.directory) / "study"

    def rows(self, query):
        with contextlib.closing(sqlite3.connect(self.study / "study.db")) as database:
            return database.execute(query).fetchall()

    def answered(self):
        return self.rows("SELECT number, response FROM trial JOIN response USING (trial_id) "
                         "WHERE status = 'answered' ORDER BY number")

    def test_discrimination_is_answered_to_its_end(self):
        terminal = Terminal("discrimination.yaml", self.study)
        named = ["acrylic_two", "mdf_two", "acrylic_three", "mdf_three"]
        for trial in range(1, 9):
            terminal.wait_for(rf"Trial {trial} of 8")
            terminal.wait_for(PROMPT.pattern)
            terminal.answer(str(trial % 4 + 1), trial)
        self.assertEqual(terminal.exit_code(), 0, terminal.said)
        self.assertEqual(self.answered(), [(n, named[n % 4]) for n in range(1, 9)])

    def test_both_choices_are_answered_once_all_were_felt(self):
        for study, label in (("reality_vibration.yaml", "B"), ("reality_finger.yaml", "C")):
            self.study = Path(self.directory) / study
            terminal = Terminal(study, self.study)
            terminal.wait_for(PROMPT.pattern)
            terminal.answer("= " + label, 0)  # nothing was felt yet
            self.assertEqual(self.rows("SELECT * FROM response"), [])
            end = time.monotonic() + PATIENCE_S
            while not terminal.has_ended() and time.monotonic() < end:
                for felt in "ABC":
                    terminal.type(felt + "\n")
                    time.sleep(1.0)
                with contextlib.suppress(OSError):
                    terminal.answer("= " + label, 0)
            self.assertEqual(terminal.exit_code(), 0, terminal.said)
            chosen = self.rows("SELECT label FROM alternative JOIN response USING (trial_id) "
                               "WHERE alternative.stimulus = response.response")
            self.assertEqual(chosen, [(label,)])

    def test_a_stopped_and_a_vanished_terminal_lose_nothing(self):
        terminal = Terminal("discrimination.yaml", self.study)
        terminal.wait_for(PROMPT.pattern)
        terminal.type(CTRL_S)  # which must not stop what is written
        terminal.answer("1", 1)
        terminal.wait_for(r"Trial 2 of 8")
        terminal.type(CTRL_Q)
        terminal.answer("2", 2)
        terminal.wait_for(r"Trial 3 of 8")
        os.close(terminal.descriptor)
        end = time.monotonic() + PATIENCE_S
        while not terminal.has_ended() and time.monotonic() < end:
            time.sleep(0.1)
        self.assertEqual(self.answered(), [(1, "acrylic_two"), (2, "mdf_two")])
        terminal = Terminal("discrimination.yaml", self.study, "--resume")
        terminal.wait_for(r"2 of 8 trials are done, 6 left")
        for trial in range(3, 9):
            terminal.wait_for(rf"Trial {trial} of 8")
            terminal.wait_for(PROMPT.pattern)
            terminal.answer("3", trial)
        self.assertEqual(terminal.exit_code(), 0, terminal.said)
        self.assertEqual([number for number, _ in self.answered()], list(range(1, 9)))


if __name__ == "__main__":
    signal.alarm(600)
    unittest.main(verbosity=2)
