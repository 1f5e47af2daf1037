"""A session of the real program with its pages, in a directory of its own."""
import os
import shutil
import signal
import sqlite3
import subprocess
import tempfile
import time
from pathlib import Path

PROGRAM = os.environ["TAPSTUDY_PROGRAM"]
SOURCE = Path(__file__).resolve().parents[2]


class Session:
    def __init__(self, protocol, *options, directory=None, log_directory=None, participant="P01"):
        self.directory = Path(directory or tempfile.mkdtemp(prefix="tapstudy_pages_"))
        self.is_own = directory is None
        self.log_path = Path(log_directory or self.directory) / "log.txt"
        self.log = open(self.log_path, "w+")
        self.process = subprocess.Popen(
            [PROGRAM, "run", str(SOURCE / protocol), "--participant", participant,
             "--out", str(self.directory / "study"), "--console", *options],
            stdin=subprocess.PIPE, stdout=self.log, stderr=subprocess.STDOUT, text=True)
        self.participant = self._address("participant's page:")
        self.operator = self._address("operator's page:")

    def _address(self, name, patience_s=120):
        end = time.monotonic() + patience_s
        while time.monotonic() < end:
            for line in self.said().splitlines():
                if line.startswith(name):
                    return line.split()[-1]
            if self.process.poll() is not None:
                break
            time.sleep(0.05)
        raise AssertionError(f"no {name} The program said:\n{self.said()}")

    def said(self):
        return self.log_path.read_text()

    def type(self, line):
        """At the operator's terminal."""
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def wait(self, patience_s=60):
        return self.process.wait(patience_s)

    def rows(self, query):
        database = sqlite3.connect(f"file:{self.directory}/study/study.db?mode=ro", uri=True)
        try:
            return database.execute(query).fetchall()
        finally:
            database.close()

    def responses(self):
        return [row[0] for row in self.rows(
            "SELECT response FROM current_response JOIN trial USING (trial_id) "
            "WHERE status = 'answered' ORDER BY number")]

    def kill(self):
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()

    def close(self):
        if self.process.poll() is None:
            self.kill()
        self.process.stdin.close()
        self.log.close()
        if self.is_own:
            shutil.rmtree(self.directory)
