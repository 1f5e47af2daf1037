#!/usr/bin/python3
"""Reads the trace of a trial from a study's study.db: the format is in trace_format.md.

    read_trace.py my_study/study.db 7 > trial_7.csv

or from Python: read_trace.trace("my_study/study.db", 7)["penetration_m"], and what an actuator was
given: read_trace.actuator("my_study/study.db", 7)["command_n"]
Takes Debian's python3-numpy and python3-zstandard.
"""
import sqlite3
import sys

import numpy
import zstandard

REALS = ("position_x_m position_y_m position_z_m velocity_x_m_s velocity_y_m_s velocity_z_m_s "
         "penetration_m penalty_n vibration_n sinusoid_n force_x_n force_y_n force_z_n "
         "achieved_x_n achieved_y_n achieved_z_n pose_residual_m closure_margin motor_voltage_v")
BYTES = "alternative touching impact saturated fault_code missed_replies late"
RECORD = numpy.dtype([("t_ns", "<i8")] + [(name, "<f8") for name in REALS.split()] +
                     [(name, "u1") for name in BYTES.split()] + [("zero", "u1")])


PERIOD = numpy.dtype([("heard_at_ns", "<i8"), ("frame_ns", "<f8"), ("filled_at_ns", "<i8"),
                      ("ticks", "<u4"), ("samples", "<u2"), ("follows_gap", "u1"),
                      ("is_heard", "u1")])
SAMPLE = numpy.dtype([("heard_s", "f8"), ("command_n", "f8"), ("is_heard", "?")])


def trace(database, trial_id):
    """A record array, one record a tick, in order; empty if the trial has no trace."""
    chunks = [numpy.empty(0, RECORD)]
    with sqlite3.connect(f"file:{database}?mode=ro", uri=True) as connection:
        for ticks, codec, frame in connection.execute(
                "SELECT ticks, codec, bytes FROM trace_chunk WHERE trial_id = ? "
                "ORDER BY first_tick", (trial_id,)):
            assert codec == "tapstudy-trace/3", f"{codec}: not the format that this reads"
            rows = numpy.frombuffer(zstandard.decompress(frame), "u1").reshape(RECORD.itemsize, -1)
            assert rows.shape[1] == ticks
            chunks.append(numpy.ascontiguousarray(rows.T).view(RECORD).ravel())
    return numpy.concatenate(chunks)


def actuator(database, trial_id):
    """A record array, one record a sample, in order; empty if none are stored of the trial."""
    chunks = [numpy.empty(0, SAMPLE)]
    with sqlite3.connect(f"file:{database}?mode=ro", uri=True) as connection:
        for count, size, codec, frame, full_scale_n in connection.execute(
                "SELECT periods, samples, codec, bytes, full_scale_n FROM actuator_chunk "
                "JOIN actuator USING (trial_id) WHERE trial_id = ? ORDER BY first_period",
                (trial_id,)):
            assert codec == "tapstudy-actuator/1", f"{codec}: not the format that this reads"
            content = numpy.frombuffer(zstandard.decompress(frame), "u1")
            of_periods, of_samples = numpy.split(content, [PERIOD.itemsize * count])
            periods = numpy.ascontiguousarray(
                of_periods.reshape(PERIOD.itemsize, -1).T).view(PERIOD).ravel()
            values = numpy.ascontiguousarray(of_samples.reshape(4, -1).T).view("<f4").ravel()
            assert len(values) == size == periods["samples"].sum()
            chunk = numpy.empty(size, SAMPLE)
            end = periods["samples"].cumsum(dtype="i8")
            within = numpy.arange(size) - numpy.repeat(end - periods["samples"], periods["samples"])
            each = numpy.repeat(periods, periods["samples"])
            chunk["heard_s"] = 1e-9 * (each["heard_at_ns"] + within * each["frame_ns"])
            chunk["command_n"] = full_scale_n * values.astype("f8")
            chunk["is_heard"] = each["is_heard"]
            chunks.append(chunk)
    return numpy.concatenate(chunks)


if __name__ == "__main__":
    names = RECORD.names[:-1]
    print(*names, sep=",")
    for record in trace(sys.argv[1], int(sys.argv[2])).tolist():
        print(*record[:-1], sep=",")
