#!/usr/bin/python3
"""pages_bench.py TAPSTUDY: how late the loop of a session with pages wakes without any load and in a
flood: 8 threads that ask as fast as they can, half of them for three.module.js, half for the page
itself, and 40 streams of which 30 are never read. Sessions in pairs, in turns: medians over the trials, and of the ratios of the pairs."""
import os
import signal
import statistics
import subprocess
import sys
import threading
import time
from pathlib import Path
from urllib.parse import urlparse

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "pages"))
from page_client import NETWORK, ask, next_trial_screen, open_stream, post

PAIRS = 5
SECONDS_PER_TRIAL = 2
PATIENCE_S = 60
FLOODS, STREAMS, UNREAD = 8, 40, 30
# ---- the load, a program of its own: it must not take the participant's Python

def ask_on(url, path, served):
    while True:
        try:
            served.append(len(ask(url, "GET", path)[1]))
        except NETWORK:
            time.sleep(0.001)


def read_on(url):
    while True:
        try:
            with open_stream(url) as connection:
                while connection.recv(65536):
                    pass
        except OSError:
            time.sleep(0.05)


def never_read(url):
    """Opened again once it was closed by the other side: sending then fails."""
    while True:
        try:
            with open_stream(url, buffer_bytes=1024) as connection:
                while True:
                    time.sleep(0.5)
                    connection.sendall(b"\r\n")
        except OSError:
            time.sleep(0.05)


def load(url):
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGTERM])
    served = []
    acts = [(ask_on, (url, path, served)) for path in ("three.module.js", "")] * (FLOODS // 2)
    acts += [(never_read, (url,))] * UNREAD
    for act, arguments in acts + [(read_on, (url,))] * (STREAMS - UNREAD):
        threading.Thread(target=act, args=arguments, daemon=True).start()
    signal.sigwait([signal.SIGTERM])
    print(sum(served) / 1e6, flush=True)
    os._exit(0)


# ---- the participant

def take_part(session):
    """Answers each trial after so long."""
    url = urlparse(session.participant)
    last = None
    accepted = time.monotonic()
    while session.process.poll() is None:
        try:
            screen = next_trial_screen(url)
            if screen != last:
                time.sleep(SECONDS_PER_TRIAL)
            last = screen
            if post(url, {"screen": screen, "action": "answer", "value": "1"}) == 200:
                accepted = time.monotonic()
            assert time.monotonic() - accepted < PATIENCE_S, "answers are refused"
        except NETWORK:
            time.sleep(0.02)


def measure(session, is_flooded):
    """p99.9 of each trial in microseconds, and what was served to the load in MB."""
    flood = [sys.executable, __file__, "--load", session.participant] if is_flooded else ["true"]
    with subprocess.Popen(flood, stdout=subprocess.PIPE, text=True) as process:
        take_part(session)
        process.terminate()
        served = float(process.communicate()[0] or 0)
    rows = session.rows("SELECT 1e6 * lateness_p999_s FROM tick_statistics")
    session.close()
    return [row[0] for row in rows], served


def compare(start):
    quiet, flooded, ratios = [], [], []
    print("lateness p99.9 of a trial [us], median\n"
          "             no load     flood     ratio   served [MB]")
    for pair in range(1, PAIRS + 1):
        one, _ = measure(start(), False)
        other, served = measure(start(), True)
        ratios.append(statistics.median(other) / statistics.median(one))
        quiet += one
        flooded += other
        print(f"  pair {pair}{statistics.median(one):>13.0f}{statistics.median(other):>10.0f}"
              f"{ratios[-1]:>10.2f}{served:>14.0f}", flush=True)
    print(f"  all   {statistics.median(quiet):>13.0f}{statistics.median(flooded):>10.0f}"
          f"{statistics.median(ratios):>10.2f}")


def main():
    if sys.argv[1] == "--load":
        load(urlparse(sys.argv[2]))
    os.environ["TAPSTUDY_PROGRAM"] = os.path.abspath(sys.argv[1])
    from program import Session  # which takes its program from the environment
    compare(lambda: Session("protocols/paper/discrimination.yaml"))


main()
