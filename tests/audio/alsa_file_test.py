"""Masking noise of a session as ALSA writes it to a file: its plug-in `file` over `null`."""
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy
from noise_laws import NoiseLaws, answers
from program import session_on

RATE_HZ = 48000


class FileSession(NoiseLaws, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        directory = Path(tempfile.mkdtemp(prefix="tapstudy_alsa_"))
        cls.addClassCleanup(shutil.rmtree, directory)
        played = directory / "played.raw"
        command = session_on(f"file:FILE={played},FORMAT=raw", directory)
        done = subprocess.run(command, input=answers(), capture_output=True, text=True, timeout=120)
        assert done.returncode == 0, done.stdout + done.stderr
        assert "not played" not in done.stderr, done.stderr
        samples = numpy.fromfile(played, "<i4").astype(float) / 2147483647.0
        cls.hear(samples.reshape(-1, 2).T, RATE_HZ)


if __name__ == "__main__":
    unittest.main(argv=sys.argv, verbosity=2)
