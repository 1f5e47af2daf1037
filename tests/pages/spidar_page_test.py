"""A session at a page with a SPIDAR (a mocked board): the operator homes it by a command."""
import os
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path
from urllib.parse import urlparse

from page_client import NETWORK, next_trial_screen, open_stream, post
from program import PROGRAM, Session

LAB = os.environ["TAPSTUDY_LAB"]
STUDY = Path(os.environ["TAPSTUDY_SPIDAR_STUDY"])  # study.yaml, rig.yaml and its calibration


class SpidarSession(Session):
    def __init__(self):
        self.directory = Path(tempfile.mkdtemp(prefix="tapstudy_pages_"))
        self.is_own = True
        self.log_path = self.directory / "log.txt"
        self.log = open(self.log_path, "w+")
        self.process = subprocess.Popen(
            ["/usr/bin/env", "LD_PRELOAD=libumockdev-preload.so.0", LAB,
             str(self.directory / "report.json"), "--", PROGRAM, "run", str(STUDY / "study.yaml"),
             "--rig", str(STUDY / "rig.yaml"), "--participant", "P01",
             "--out", str(self.directory / "study"), "--console"],
            stdin=subprocess.PIPE, stdout=self.log, stderr=subprocess.STDOUT, text=True)
        self.participant = self._address("participant's page:")
        self.operator = self._address("operator's page:")


class SpidarPageTest(unittest.TestCase):
    def test_the_operator_homes_it_and_the_page_answers(self):
        """Again where the mocked kernel gives up, which a kernel does not: see the session's tests."""
        for _ in range(4):
            session = self.answered_session()
            said = session.said()
            self.assertIn("Hold the grip in the middle of the frame", said)
            if "all 4 trials are stored" in said:
                break
        self.assertIn("stored: resume", said)
        self.assertEqual(len(session.responses()), 4, said)

    def answered_session(self):
        session = SpidarSession()
        self.addCleanup(session.close)
        page = urlparse(session.participant)
        self.addCleanup(open_stream(page).close)  # somebody is there all the time
        end = time.monotonic() + 60
        while session.process.poll() is None and time.monotonic() < end:
            try:
                post(page, {"screen": next_trial_screen(page), "action": "answer", "value": "1"})
            except NETWORK:
                time.sleep(0.05)  # the program is ending
        return session


if __name__ == "__main__":
    unittest.main(argv=sys.argv, verbosity=2)
