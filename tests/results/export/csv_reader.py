"""What pandas and R read of an exported study is what sqlite3 reads of its store.

Usage: csv_reader.py STUDY EXPORT. Prints the tables compared; fails with the first difference.
"""
import json
import math
import re
import sqlite3
import subprocess
import sys

import pandas

R_SCRIPT = """
files <- commandArgs(TRUE)
types <- function(file) {
  metadata <- jsonlite::read_json(file.path(dirname(file), "csv-metadata.json"))
  table <- Find(function(t) t$url == basename(file), metadata$tables)
  texts <- Filter(function(c) c$datatype == "string", table$tableSchema$columns)
  names <- vapply(texts, function(c) c$name, "")
  setNames(rep("character", length(names)), names)
}
read <- function(file) lapply(
  read.csv(file, check.names = FALSE, encoding = "UTF-8", colClasses = types(file)),
  function(x) if (is.numeric(x)) ifelse(is.na(x), NA, sprintf("%.17g", x)) else as.character(x))
cat(jsonlite::toJSON(lapply(files, read), na = "null"))
"""
FROM = {
    "sessions": "v_sessions ORDER BY session_id",
    "trials": "v_trials ORDER BY trial_id",
    "answers": "v_answers ORDER BY response_id",
    "visits": "v_visits ORDER BY trial_id, visit",
    "alternatives": "v_stimuli ORDER BY trial_id, position",
    "events": "event JOIN trial_context USING (trial_id) ORDER BY trial_id, t_s, event.rowid",
    "session_events": "session_event JOIN v_sessions USING (session_id) "
                      "ORDER BY session_id, t_s, session_event.rowid",
    "questionnaires": "form_answer JOIN v_sessions USING (session_id) "
                      "ORDER BY session_id, t_s, form_answer.rowid",
    "operator_actions": "operator_action JOIN v_sessions USING (session_id) ORDER BY action_id",
}


def text_of(cell):
    """As csv-metadata.json says: without the apostrophe that guards it from spreadsheets."""
    behind = cell.lstrip("'")
    is_formula = behind[:1] in tuple("=+-@\t\r\n\uff1d\uff0b\uff0d\uff20")
    is_number = re.fullmatch(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", behind)
    return cell[1:] if cell[:1] == "'" and is_formula and not is_number else cell


def same(read, stored, tolerance=0.0):
    if stored is None:
        return read is None or (isinstance(read, float) and math.isnan(read))
    if isinstance(stored, str):
        return (isinstance(read, str) and text_of(read) == stored) or (stored == "" and not isinstance(read, str))
    return math.isclose(float(read), stored, rel_tol=tolerance, abs_tol=0.0)


def check(table, column, who, read, stored, tolerance=0.0):
    assert len(read) == len(stored), f"{who} {table}: {len(read)} rows, stored {len(stored)}"
    for row, (a, b) in enumerate(zip(read, stored)):
        assert same(a, b, tolerance), f"{who} {table}.{column}[{row}]: read {a!r}, stored {b!r}"


def main(study, export):
    database = sqlite3.connect(f"file:{study}/study.db?mode=ro", uri=True)
    metadata = json.load(open(f"{export}/csv-metadata.json"))
    assert metadata["@context"] == "http://www.w3.org/ns/csvw"
    tables = {t["url"][:-4]: t for t in metadata["tables"] if "/" not in t["url"]}
    names = [name for name in tables if name in FROM]
    assert set(names) == set(FROM)
    files = [f"{export}/{name}.csv" for name in names]
    by_r = json.loads(subprocess.run(["/usr/bin/Rscript", "--vanilla", "-e", R_SCRIPT, *files],
                                     check=True, capture_output=True, text=True).stdout)
    for name, in_r in zip(names, by_r):
        columns = [c["name"] for c in tables[name]["tableSchema"]["columns"]]
        texts = {c["name"]: object for c in tables[name]["tableSchema"]["columns"]
                 if c["datatype"] == "string"}
        frame = pandas.read_csv(f"{export}/{name}.csv", float_precision="round_trip", dtype=texts)
        assert list(frame.columns) == columns == list(in_r), name
        for column in columns:
            stored = [row[0] for row in database.execute(
                f"SELECT {column} FROM {FROM[name]}")] if column != "thickness_m" else [
                    row[0] for row in database.execute(
                        "SELECT axis_value.value FROM alternative LEFT JOIN axis_value "
                        "USING (trial_id, position) ORDER BY trial_id, position")]
            check(name, column, "pandas", list(frame[column]), stored)
            # R's text mode reads CR LF as LF, and its numbers may be off by a rounding
            as_r = [v.replace("\r\n", "\n") if isinstance(v, str) else v for v in stored]
            check(name, column, "R", in_r[column], as_r, 4.5e-16)
        assert columns.count("mode") == 1 and columns.count("is_excluded") == 1, name
        print(name, len(frame))


main(*sys.argv[1:])
