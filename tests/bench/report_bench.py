#!/usr/bin/python3
"""report_bench.py TAPSTUDY: the report of a table of a million answers of twenty people, against
pandas, which only reads the table and counts it; medians of five runs of each."""
import random
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ANSWERS = 1_000_000
PEOPLE = 20
RUNS = 5
COUNT = """import pandas, sys
table = pandas.read_csv(sys.argv[1])
print(pandas.crosstab(table["stimulus"], table["response"]))"""


def write_table(file):
    draw = random.Random(1)
    plates = ["acrylic_two", "mdf_two", "acrylic_three", "mdf_three"]
    with file.open("w") as out:
        out.write("participant,stimulus,response,response_time_s\n")
        for i in range(ANSWERS):
            plate = plates[draw.randrange(4)]
            answer = plate if draw.random() < 0.4 else plates[draw.randrange(4)]
            out.write(f"P{i * PEOPLE // ANSWERS:02},{plate},{answer},{1 + 4 * draw.random():.3f}\n")


def seconds(command):
    times = []
    for _ in range(RUNS):
        begin = time.monotonic()
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        times.append(time.monotonic() - begin)
    return statistics.median(times)


def main(program):
    with tempfile.TemporaryDirectory() as directory:
        table = Path(directory) / "answers.csv"
        write_table(table)
        ours = seconds([program, "report", "--counts", str(table), "--stimulus-column", "stimulus",
                        "--response-column", "response", "--participant-column", "participant",
                        "--time-column", "response_time_s", "--out", f"{directory}/report", "--replace"])
        theirs = seconds([sys.executable, "-c", COUNT, str(table)])
        print(f"a report of {ANSWERS} answers: {ours:.2f} s, {ours / theirs:.1f} of pandas that counts ({theirs:.2f} s)")


if __name__ == "__main__":
    main(sys.argv[1])
