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
                if column == "alternatives":
                    presented = database.execute(
                        "SELECT stimulus FROM alternative WHERE trial_id = ? ORDER BY position",
                        (row["trial_id"],)).fetchall()
                    names = [one.split(" (")[0].rstrip("*") for one in read.split("; ")]
                    assert names == [name for name, in presented], read
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
    labels = dict(zip([row[0] for row in database.execute(
        "SELECT participant_id FROM v_sessions GROUP BY participant_id ORDER BY min(session_id)")],
        participants["participant_id"]))
    compare_participants(database, dataset, labels)
    print(trials, "trials", recordings, "recordings",
          compared_answers(database, dataset, labels), "answers",
          compared_events(database, dataset), "events")


def compare_participants(database, dataset, labels):
    """Age and handedness are asked by the form 'about' of every_screen.yaml."""
    participants = pandas.read_csv(f"{dataset}/participants.tsv", sep="\t", dtype=str,
                                   keep_default_na=False).set_index("participant_id")
    for column, item in (("age", "age"), ("handedness", "hand")):
        asked = dict(database.execute("SELECT participant_id, answer FROM form_answer JOIN v_sessions USING (session_id) "
                                      "WHERE item = ?", (item,)))
        assert asked
        for person, label in labels.items():
            assert participants.loc[label, column] == (asked.get(person) or "n/a"), (person, column)


def compared_answers(database, dataset, labels):
    """Of the forms of every_screen.yaml, whose only free text is 'remarks'."""
    compared = 0
    for form, asked in (("about", "session begin"), ("rating", "main")):
        table = pandas.read_csv(f"{dataset}/phenotype/{form}.tsv", sep="\t", dtype=str,
                                keep_default_na=False).set_index("participant_id")
        described = json.load(open(f"{dataset}/phenotype/{form}.json"))
        assert "remarks" not in table.columns
        assert set(described) == {"MeasurementToolMetadata", *table.columns}, described
        for person, item, answer in database.execute(
                "SELECT participant_id, item, answer FROM form_answer JOIN v_sessions "
                "USING (session_id) WHERE form = ? AND asked = ? AND item <> 'remarks'", (form, asked)):
            assert table.loc[labels[person], item] == (answer or "n/a"), (person, item, answer)
            compared += 1
    assert described["real"]["Levels"] == {"1": "not at all", "5": "fully"}
    return compared


def compared_events(database, dataset):
    read = sorted(
        (row["onset"], row["trial_type"], row["trial"])
        for file in glob.glob(f"{dataset}/sub-*/**/*_events.tsv", recursive=True)
        for row in pandas.read_csv(file, sep="\t", na_values="n/a", float_precision="round_trip")
        .fillna({"trial": -1}).to_dict("records"))
    stored = sorted(database.execute(
        "SELECT t_s, state, coalesce(number, -1) FROM session_event WHERE session_id IN "
        "(SELECT session_id FROM trial)"))
    assert read == stored
    return len(read)


main(*sys.argv[1:])
