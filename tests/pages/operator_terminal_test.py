"""The operator at the terminal while the participant is at a page."""
import shutil
import sys
import tempfile
import time
import unittest
from pathlib import Path
from urllib.parse import urlparse

from page_client import NETWORK, next_trial_screen, open_stream, post
from program import SOURCE, Session


class OperatorTerminalTest(unittest.TestCase):
    def setUp(self):
        self.session = Session("protocols/paper/discrimination.yaml")
        self.addCleanup(self.session.close)
        page = urlparse(self.session.participant)
        self.addCleanup(open_stream(page).close)  # a page that nobody watches pauses the session
        next_trial_screen(page)

    def says(self, text, count=1, patience_s=120):
        end = time.monotonic() + patience_s
        while time.monotonic() < end:
            if self.session.said().count(text) >= count:
                return
            time.sleep(0.1)
        self.fail(f"'{text}' was not said {count} times:\n{self.session.said()}")

    def test_status_shows_the_running_trial_and_stores_nothing(self):
        self.session.type("status")
        self.says("trial 1 of 8")
        self.says("late ticks: ")
        self.assertEqual(self.session.rows("SELECT * FROM operator_action"), [])

    def test_watch_shows_force_and_height_until_the_next_line(self):
        self.session.type("watch")
        self.says("height", 2)
        self.session.type("note it is watched")
        self.says("stored: note")
        lines = self.session.said().count("height")
        time.sleep(2.5)
        self.assertEqual(self.session.said().count("height"), lines)


class TimedBreakTest(unittest.TestCase):
    def test_a_break_with_an_end_ends_without_anybody(self):
        directory = tempfile.mkdtemp(prefix="tapstudy_breaks_")
        self.addCleanup(shutil.rmtree, directory)
        study = Path(directory) / "study.yaml"
        study.write_text((SOURCE / "protocols/paper/discrimination.yaml").read_text().replace(
            "    task: identification\n",
            "    task: identification\n    breaks: {every_trials: 1, max_seconds: 0.5}\n", 1))
        session = Session(study)
        self.addCleanup(session.close)
        page = urlparse(session.participant)
        end = time.monotonic() + 120
        while session.process.poll() is None and time.monotonic() < end:
            try:
                post(page, {"screen": next_trial_screen(page), "action": "answer", "value": "1"})
            except NETWORK:
                pass  # the session is over
            time.sleep(0.2)
        self.assertEqual(session.wait(), 0, session.said())
        self.assertEqual(session.rows(
            "SELECT count(*) FROM session_event WHERE state = 'resting'"), [(7,)])


if __name__ == "__main__":
    unittest.main(argv=sys.argv, verbosity=2)
