"""What h5py reads of an exported study is what sqlite3 and the shipped reader read of its store.

Usage: hdf5_reader.py STUDY FILE [EMPTY TABLE…]. Prints what was compared; fails with the first difference.
"""
import math
import sqlite3
import sys

import h5py
import numpy

sys.dont_write_bytecode = True
sys.path.insert(0, __file__.rsplit("/tests/", 1)[0] + "/results")
import read_trace  # noqa: E402

FROM = {"sessions": "v_sessions ORDER BY session_id", "trials": "v_trials ORDER BY trial_id",
        "answers": "v_answers ORDER BY response_id",
        "questionnaires": "form_answer JOIN v_sessions USING (session_id) "
                          "ORDER BY session_id, t_s, form_answer.rowid"}


def same(read, stored):
    if isinstance(read, bytes):
        return read.decode() == ("NA" if stored is None else stored)
    return math.isnan(read) if stored is None else read == stored


def main(study, file, *empty):
    exported = h5py.File(file)
    database = sqlite3.connect(f"file:{study}/study.db?mode=ro", uri=True)
    text, = database.execute("SELECT protocol_text FROM study").fetchone()
    assert exported["protocol"][0].decode() == text
    for name, source in FROM.items():
        table = exported["tables"][name]
        assert sorted(table) == sorted(table.attrs["columns"])
        for column in table:
            stored = [row[0] for row in database.execute(f"SELECT {column} FROM {source}")]
            read = table[column][()].tolist()
            assert len(read) == len(stored), f"{name}.{column}"
            assert (len(stored) == 0) == (name in empty), f"{name}.{column}"
            for row, (a, b) in enumerate(zip(read, stored)):
                assert same(a, b), f"{name}.{column}[{row}]: read {a!r}, stored {b!r}"
            assert table[column].attrs["description"], column
            assert isinstance(table[column].attrs["unit"], str)
    trials = [row[0] for row in database.execute("SELECT DISTINCT trial_id FROM trace_chunk")]
    assert sorted(exported["traces"]) == [f"trial_{trial:06}" for trial in sorted(trials)]
    ticks = 0
    columns = list(exported["traces"].attrs["columns"])
    assert list(exported["traces"].attrs["units"])[:2] == ["ns", "m"]
    for trial in trials:
        matrix = exported[f"traces/trial_{trial:06}"]
        stored = read_trace.trace(f"{study}/study.db", trial)
        assert matrix.attrs["trial_id"] == trial
        mode, = database.execute("SELECT mode FROM v_trials WHERE trial_id = ?", (trial,)).fetchone()
        assert f"({mode})" in matrix.attrs["description"]
        assert columns == list(stored.dtype.names[:-1])
        assert (matrix.compression, matrix.shuffle) == ("gzip", True)
        for i, column in enumerate(columns):
            expected = stored[column].astype("f8")
            assert matrix[i].tobytes() == expected.tobytes(), f"trial {trial}: {column}"
        ticks += len(stored)
    played = [row[0] for row in database.execute("SELECT DISTINCT trial_id FROM actuator_chunk")]
    assert sorted(exported.get("actuator", [])) == [f"trial_{trial:06}" for trial in sorted(played)]
    for trial in played:
        stored = read_trace.actuator(f"{study}/study.db", trial)
        matrix = exported[f"actuator/trial_{trial:06}"]
        assert len(stored) > 0
        for i, column in enumerate(exported["actuator"].attrs["columns"]):
            assert matrix[i].tobytes() == stored[column].astype("f8").tobytes(), f"{trial}: {column}"
    print(len(played), "trials of actuators")
    print(len(trials), "trials", ticks, "ticks", numpy.dtype("f8").itemsize, "bytes a number")


main(*sys.argv[1:])
