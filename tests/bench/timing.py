"""What benches of timing share: quantiles, and a machine that is busy."""
import contextlib
import os
import shutil
import subprocess
import sys
import tempfile


def require(*programs):
    if not all(map(shutil.which, programs)):
        sys.exit(f"this takes {' and '.join(programs)}: apt-get install rt-tests stress-ng")


def quantile(times, share):
    """Of sorted times; of none it is not a number."""
    return times[min(len(times) - 1, int(share * len(times)))] if times else float("nan")


@contextlib.contextmanager
def stress_ng():
    """Every processor computes, and one process writes to the disk."""
    with tempfile.TemporaryDirectory() as folder:
        load = subprocess.Popen(["stress-ng", "--cpu", str(os.cpu_count()), "--hdd", "1",
                                 "--hdd-bytes", "64m", "--temp-path", folder, "--quiet"])
        try:
            yield
        finally:
            load.terminate()
            load.wait()
