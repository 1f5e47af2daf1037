#!/usr/bin/python3
"""loop_bench.py LOOP_BENCH: how late the haptic loop wakes beside cyclictest, at the same priority
and period, taken in turns, idle and under stress-ng."""
import os
import subprocess
import sys

import timing

PRIORITY, PERIOD_US, TICKS, ROUNDS = 80, 1000, 3000, 7
SHARE = 0.999
LATEST_US = 20000


def ours(program):
    out = subprocess.run([program, str(PRIORITY), str(PERIOD_US), str(TICKS)], check=True,
                         capture_output=True, text=True).stdout
    return [1e-3 * float(line) for line in out.split()]


def cyclictest():
    """Quiet until the end, as the loop is: a second thread that prints keeps a virtual machine awake.
    Its histogram's rows are: latency in microseconds, number of cycles; later ones are counted."""
    rows = subprocess.run(["cyclictest", "-q", "-m", "-t1", f"-p{PRIORITY}", f"-i{PERIOD_US}",
                           f"-l{TICKS}", f"-h{LATEST_US}"], check=True, capture_output=True,
                          text=True).stdout.splitlines()
    late_us = []
    for row in rows:
        words = row.split()
        if len(words) == 2 and all(word.isdigit() for word in words):
            late_us += [float(words[0])] * int(words[1])
    return late_us + [LATEST_US] * (TICKS - len(late_us))


def compare(name, program):
    all_theirs, all_own = [], []
    for _ in range(ROUNDS):
        all_theirs += cyclictest()
        all_own += ours(program)
    theirs, own = (timing.quantile(sorted(late_us), SHARE) for late_us in (all_theirs, all_own))
    print(f"  {name:<10}{theirs:>12.0f}{own:>12.0f}{own / theirs:>10.2f}", flush=True)


def main():
    program = os.path.abspath(sys.argv[1])
    timing.require("cyclictest", "stress-ng")
    print(f"lateness [us], p99.9 of {ROUNDS} x {TICKS} ticks of {PERIOD_US} us at priority {PRIORITY}")
    print("              cyclictest    tapstudy     ratio")
    compare("idle", program)
    with timing.stress_ng():
        compare("stress-ng", program)


main()
