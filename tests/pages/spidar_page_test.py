"""A session at a page with a SPIDAR (a mocked board): the operator homes it by a command."""
import http.client
import json
import os
import re
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path
from urllib.parse import urlparse

from program import PROGRAM, Session

LAB = os.environ["TAPSTUDY_LAB"]
STUDY = Path(os.environ["TAPSTUDY_SPIDAR_STUDY"])  # study.yaml, rig.yaml and its calibration


class SpidarSession(Session):
    def __init__(self):
        self.directory = Path(tempfile.mkdtemp(prefix="tapstudy_pages_"))
        self.is_own = True
        self.log = open(self.directory / "log.txt", "w+")
        self.process = subprocess.Popen(
            ["/usr/bin/env", "LD_PRELOAD=libumockdev-preload.so.0", LAB,
             str(self.directory / "report.json"), "--", PROGRAM, "run", str(STUDY / "study.yaml"),
             "--rig", str(STUDY / "rig.yaml"), "--participant", "P01",
             "--out", str(self.directory / "study"), "--console"],
            stdin=subprocess.PIPE, stdout=self.log, stderr=subprocess.STDOUT, text=True)
        self.participant = self._address("participant's page:")
        self.operator = self._address("operator's page:")


class SpidarPageTest(unittest.TestCase):
    def post(self, url, message):
        connection = http.client.HTTPConnection(url.hostname, url.port, timeout=10)
        try:
            connection.request("POST", url.path + "input", json.dumps(message), {"X-Tapstudy": "1"})
            return connection.getresponse().status
        finally:
            connection.close()

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
        stream = socket.create_connection((page.hostname, page.port), timeout=10)
        self.addCleanup(stream.close)
        stream.sendall(f"GET {page.path}events HTTP/1.1\r\nHost: {page.netloc}\r\n\r\n".encode())
        received = b""
        end = time.monotonic() + 60
        while session.process.poll() is None and time.monotonic() < end:
            try:
                received = (received + stream.recv(65536))[-20000:]
                screens = re.findall(rb'"number":(\d+),"language":"en","kind":"(\w+)"', received)
                if screens and screens[-1][1] == b"trial":
                    self.post(page, {"screen": int(screens[-1][0]), "action": "answer", "value": 0})
            except (OSError, http.client.HTTPException):
                time.sleep(0.05)  # the program is ending
        return session


if __name__ == "__main__":
    unittest.main(argv=sys.argv, verbosity=2)
