"""What pandas reads of a BIDS dataset is what is in the store.

Usage: bids_reader.py STUDY DATASET. Prints how many trials and recordings were compared.
"""
import glob
import json
import sqlite3
import sys

import numpy
import pandas

sys.dont_write_bytecode = True
sys.path.insert(0, __file__.rsplit("/tests/", 1)[0] + "/results")
import read_trace  # noqa: E402

STORED = {"trial": "number", "trial_type": "stimulus", "response_time": "response_time_s"}


def main(study, dataset):
    database = sqlite3.connect(f"file:{study}/study.db?mode=ro", uri=True)
    participants = pandas.read_csv(f"{dataset}/participants.tsv", sep="\t")
    modes = sorted(row[0] for row in database.execute("SELECT mode FROM participant"))
    assert sorted(participants["mode"]) == modes
    trials = recordings = 0
    for file in glob.glob(f"{dataset}/sub-*/**/*_beh.tsv", recursive=True):
        table = pandas.read_csv(file, sep="\t", na_values="n/a", float_precision="round_trip")
        task = file.split("_task-")[1].split("_")[0]
        described = json.load(open(f"{dataset}/task-{task}_beh.json"))
        for column in table.columns:
            assert described[column]["Description"], column
        assert described["trial_type"]["Levels"]["ringing"] == "with vibration"
        assert file.split("/")[-4 if "ses-" in file else -3] in set(participants["participant_id"])
        for row in table.to_dict("records"):
            for column, read in row.items():
                if column == "recording":
                    continue
                stored, = database.execute(
                    f"SELECT {STORED.get(column, column)} FROM v_trials WHERE trial_id = ?",
                    (row["trial_id"],)).fetchone()
                assert (stored is None and read != read) or stored == read, (column, stored, read)
            physio = file.replace("_beh.tsv", f"_recording-{row['recording']}_physio")
            sidecar = json.load(open(physio + ".json"))
            trace = pandas.read_csv(physio + ".tsv.gz", sep="\t", header=None, na_values="n/a",
                                    names=sidecar["Columns"], float_precision="round_trip")
            stored = read_trace.trace(f"{study}/study.db", row["trial_id"])
            assert sidecar["SamplingFrequency"] == 1000
            for name in stored.dtype.names[:-1]:
                assert numpy.array_equal(trace[name].to_numpy(dtype=float),
                                         stored[name].astype(float), equal_nan=True), name
            recordings += 1
        trials += len(table)
    assert trials == database.execute("SELECT count(*) FROM trial").fetchone()[0]
    print(trials, "trials", recordings, "recordings")


main(*sys.argv[1:])
