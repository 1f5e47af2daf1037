"""The shipped reader of traces and the traces of a CSV export agree in every bit.

Usage: traces_match.py STUDY EXPORT. Prints how many trials and ticks were compared.
"""
import glob
import sys

import numpy
import pandas

sys.dont_write_bytecode = True
sys.path.insert(0, __file__.rsplit("/tests/", 1)[0] + "/results")
import read_trace  # noqa: E402


def main(study, export):
    ticks = 0
    files = sorted(glob.glob(f"{export}/traces/*.csv"))
    for file in files:
        frame = pandas.read_csv(file, float_precision="round_trip")
        stored = read_trace.trace(f"{study}/study.db", int(file[-10:-4]))
        names = [name for name in stored.dtype.names if name != "zero"]
        assert list(frame.columns) == names, frame.columns
        assert len(frame) == len(stored) > 0, file
        assert not stored["zero"].any()
        for name in names:
            read = frame[name].to_numpy().astype(stored[name].dtype)
            equal = (read == stored[name]) | (read != read) & (stored[name] != stored[name])
            equal &= numpy.signbit(read) == numpy.signbit(stored[name]) if read.dtype == "f8" and \
                not numpy.isnan(read).any() else True
            assert equal.all(), f"{file}: {name} differs at tick {numpy.argmin(equal)}"
        ticks += len(stored)
    print(len(files), "trials", ticks, "ticks")
    for file in sorted(glob.glob(f"{export}/actuator/*.csv")):
        frame = pandas.read_csv(file, float_precision="round_trip")
        stored = read_trace.actuator(f"{study}/study.db", int(file[-10:-4]))
        assert list(frame.columns) == list(stored.dtype.names), frame.columns
        assert len(frame) == len(stored) > 0, file
        for name in stored.dtype.names:
            assert (frame[name].to_numpy() == stored[name]).all(), f"{file}: {name}"


main(*sys.argv[1:])
