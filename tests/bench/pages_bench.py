#!/usr/bin/python3
"""pages_bench.py TAPSTUDY: how late the loop of a session with pages wakes while nothing is asked of
them, in a flood, and while the same flood is of another session's pages, which costs the machine as
much: 8 threads that ask as fast as they can, half of them for three.module.js, half for the page
itself, and 40 streams of which 30 are never read. In turns: medians over the trials, and of the
ratios of each turn."""
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

TURNS = 5
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
    began = time.monotonic()
    acts = [(ask_on, (url, path, served)) for path in ("three.module.js", "")] * (FLOODS // 2)
    acts += [(never_read, (url,))] * UNREAD
    for act, arguments in acts + [(read_on, (url,))] * (STREAMS - UNREAD):
        threading.Thread(target=act, args=arguments, daemon=True).start()
    signal.sigwait([signal.SIGTERM])
    print(sum(served) / 1e6, len(served) / (time.monotonic() - began), flush=True)
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


def measure(session, flooded_page):
    """p99.9 of each trial in microseconds; of the load what was served in MB, and requests a second."""
    flood = [sys.executable, __file__, "--load", flooded_page] if flooded_page else ["true"]
    with subprocess.Popen(flood, stdout=subprocess.PIPE, text=True) as process:
        take_part(session)
        process.terminate()
        served = [float(number) for number in process.communicate()[0].split()] or [0, 0]
    rows = session.rows("SELECT 1e6 * lateness_p999_s FROM tick_statistics")
    session.close()
    return [row[0] for row in rows], served


def compare(start):
    """The other session waits at its first screen all the time."""
    other = start()
    measured = {"quiet": [], "elsewhere": [], "flood": []}
    to_quiet, to_elsewhere = [], []
    print("lateness p99.9 of a trial [us], median\n"
          "           no load  flood elsewhere  flood  flood/no load  flood/elsewhere  served [MB]  requests/s")
    for turn in range(1, TURNS + 1):
        medians, served = {}, [0, 0]
        for load_of, times in measured.items():
            session = start()
            pages = {"quiet": None, "elsewhere": other.participant, "flood": session.participant}
            trials, served = measure(session, pages[load_of])
            medians[load_of] = statistics.median(trials)
            times += trials
        to_quiet.append(medians["flood"] / medians["quiet"])
        to_elsewhere.append(medians["flood"] / medians["elsewhere"])
        show(f"turn {turn}", medians, to_quiet[-1], to_elsewhere[-1], f"{served[0]:>13.0f}{served[1]:>12.0f}")
    other.close()
    show("all", {load: statistics.median(times) for load, times in measured.items()},
         statistics.median(to_quiet), statistics.median(to_elsewhere), "")


def show(name, medians, to_quiet, to_elsewhere, served):
    print(f"  {name:<6}{medians['quiet']:>10.0f}{medians['elsewhere']:>17.0f}{medians['flood']:>7.0f}"
          f"{to_quiet:>15.2f}{to_elsewhere:>17.2f}{served}", flush=True)


def main():
    if sys.argv[1] == "--load":
        load(urlparse(sys.argv[2]))
    os.environ["TAPSTUDY_PROGRAM"] = os.path.abspath(sys.argv[1])
    from program import Session  # which takes its program from the environment
    compare(lambda: Session("protocols/paper/discrimination.yaml"))


main()
