#!/usr/bin/python3
"""spidar_bench.py SPIDAR_BENCH: the time of a SPIDAR's tick with a guardian that watches it over the
time without, taken in turns in one run."""
import json
import subprocess
import sys


def main():
    out = subprocess.run([sys.argv[1], "--benchmark_repetitions=9", "--benchmark_format=json",
                          "--benchmark_enable_random_interleaving=true",
                          "--benchmark_report_aggregates_only=true"],
                         check=True, capture_output=True, text=True).stdout
    median_ns = {row["run_name"]: row["cpu_time"] for row in json.loads(out)["benchmarks"]
                 if row["aggregate_name"] == "median"}
    print("tick [ns], median of 9     alone   watched     ratio")
    for name in sorted({run.split("/")[0] for run in median_ns}):
        alone, watched = (median_ns[f"{name}/watched:{i}"] for i in (0, 1))
        print(f"  {name:<24}{alone:>8.0f}{watched:>10.0f}{watched / alone:>10.3f}")


main()
