"""A machine that is busy: every processor computes, and one process writes to the disk."""
import contextlib
import os
import shutil
import subprocess
import sys
import tempfile


def require(*programs):
    if not all(map(shutil.which, programs)):
        sys.exit(f"this takes {' and '.join(programs)}: apt-get install rt-tests stress-ng")


@contextlib.contextmanager
def stress_ng():
    with tempfile.TemporaryDirectory() as folder:
        load = subprocess.Popen(["stress-ng", "--cpu", str(os.cpu_count()), "--hdd", "1",
                                 "--hdd-bytes", "64m", "--temp-path", folder, "--quiet"])
        try:
            yield
        finally:
            load.terminate()
            load.wait()
