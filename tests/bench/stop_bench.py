#!/usr/bin/python3
"""stop_bench.py STOP_BENCH [STOPS]: how long after a signal the force of a program that renders is
set to zero by its watchdog process, idle and under stress-ng, with and without real-time priority.
A program that is stopped counts as stalled after 20 ms, so that the rest is the watchdog's share."""
import os
import subprocess
import sys

import timing

STALL_MS = {"kill": 0, "stop": 20}


def stops(program, signal, count, priority):
    lines = subprocess.run([program, signal, str(count), str(priority)], check=True,
                           capture_output=True, text=True).stdout.split()
    return sorted(1e-6 * float(line) for line in lines if line != "none"), lines.count("none")


def show(condition, program, count):
    for signal, stall_ms in STALL_MS.items():
        for priority in (80, 0):
            times_ms, never = stops(program, signal, count, priority)
            shares = [timing.quantile(times_ms, share) for share in (0.5, 0.99, 1.0)]
            late = sum(time > stall_ms + 7 for time in times_ms)
            print(f"  {condition:<10}{signal:<6}{priority:>9}" + "".join(f"{each:>9.1f}" for each in shares)
                  + f"{late:>9}{never:>7}", flush=True)


def main():
    timing.require("stress-ng")
    program, count = os.path.abspath(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1000
    print(f"time from the signal to zero force [ms], {count} stops a row on {os.cpu_count()} processors;")
    print("late: more than 7 ms after the program counts as stalled or dead")
    print("            signal priority   median      p99    worst     late  never")
    show("idle", program, count)
    with timing.stress_ng():
        show("stress-ng", program, count)


main()
