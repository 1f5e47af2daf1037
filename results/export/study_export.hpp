#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/model/progress.hpp"
#include "results/export/table.hpp"
#include "results/store/store.hpp"
namespace tapstudy::results {
struct Provenance {
  std::string title;            // of the study
  std::string protocol_sha256;  // of the protocol's text
  std::string program;          // name, version and revision of what wrote the export
};

// A file of an export and what is in it.
struct DescribedFile {
  std::string url;          // relative to the metadata
  std::string description;  // of the table
  std::string schema_url;   // of a file with the columns; empty: they are here
  std::vector<Column> columns;
};

// The data dictionary as metadata of the W3C's "CSV on the Web" (Metadata Vocabulary for Tabular
// Data, 2015): datatype, description (dc:description) and unit (schema:unitText) of each column,
// and what stands for a missing value.
std::string csvw_metadata(const Provenance& provenance, const std::vector<DescribedFile>& files);
// The schema alone, for files that share it.
std::string csvw_schema(const std::vector<Column>& columns);

// What an answer or a stimulus is called in the data, and what it means.
using Level = std::pair<std::string, std::string>;
// What a block of the protocol tells participants.
struct BlockText {
  std::string name{};
  std::string question{};
  std::string instructions{};
  std::vector<Level> stimuli{};
  std::vector<Level> responses{};  // that have a meaning; empty: plain numbers
};

// A questionnaire, and what can be answered to its items.
struct ItemText {
  std::string name;
  std::string question;
  std::vector<Level> levels;  // answers that have a meaning; empty: a number or a text
  bool is_free_text{};
  std::string participants_column{};  // of participants.tsv in BIDS; empty: none
};
struct FormText {
  std::string name;
  std::string title;
  std::vector<ItemText> items;
};

// What an export holds, whatever its format.
struct StudyExport {
  Provenance provenance;
  std::string protocol_text;
  std::vector<BlockText> blocks;
  std::vector<Table> tables;
  std::vector<FormText> forms;
  std::vector<std::int64_t> trials;  // whose traces are written: each must have one
  // Written beside the CSV tables as they are: name and text.
  std::vector<std::pair<std::string, std::string>> further_files{};
  core::CountHook count{};  // of traces written
};
void each_traced_trial(const StudyExport& study, const std::function<void(std::int64_t)>& write);

// Fills a directory: a file NAME.csv a table, csv-metadata.json (csv_export.cpp), protocol.yaml,
// further files, and of each trial that has a trace traces/trial_000001.csv, likewise actuator/.
// Throws InvalidInput where it cannot be written, StoreError where the study cannot be read.
void write_csv_files(const std::string& directory, Store& store, const StudyExport& study);

// Writes one new HDF5 file. Errors as above.
//   /protocol            its text
//   /tables/NAME/COLUMN  a dataset a column, one-dimensional; attributes unit, description. Missing
//                        numbers are NaN (a column of integers with missing ones is one of
//                        doubles), missing texts "NA"
//   /traces              attributes columns, units, descriptions
//   /traces/trial_000001 columns x ticks, doubles (in Octave and R, which count dimensions the
//   other
//                        way round, ticks x columns); attributes trial_id, description
//   /actuator            likewise, samples of actuators; only where there are any
void write_hdf5_file(const std::string& name, Store& store, const StudyExport& study);

// Fills a directory with a dataset of the Brain Imaging Data Structure (BIDS 1.8, behaviour):
// participants.tsv, phenotype/*.tsv with a row a participant, sub-*/[ses-*/]beh/*_beh.tsv with a
// row a trial, *_events.tsv with a row a change of the session's state, *_physio.tsv.gz with each
// trial's trace, JSON beside them. Names that are no labels do not appear (bids_files.hpp), nor do
// notes, reasons and free text. Errors as above.
void write_bids_dataset(const std::string& directory, Store& store, const StudyExport& study);

// The tables of a study that its store alone yields: sessions, trials, answers, alternatives,
// visits, events, session_events, questionnaires, operator_actions. All participants of all modes
// are in them, excluded ones and practice too; columns say which. Alternatives have a column for
// each axis that was varied, with the unit given here. Their rows are read from the store when they
// are asked for, and it must live as long. Throws StoreError, also when rows are read.
std::vector<Table> study_tables(Store& store, const std::map<std::string, std::string>& axis_units);

// A row of a SELECT of these columns.
Row row_from(Statement& statement, const std::vector<Column>& columns);
// Trials of which ticks are stored; of a real plate there are none.
std::vector<std::int64_t> trials_with_traces(Store& store);
// What is sampled in trials: traces, and what actuators were given where that is stored.
struct Recording {
  std::string name;  // of its folder or group
  std::vector<Column> columns;
  std::function<std::optional<Table>(std::int64_t trial_id)> of_trial;  // unset: nothing is stored
};
std::vector<Recording> recordings(Store& store);
// Every tick of a trial; columns as in trace_format.md. A NaN is where a device reports nothing.
std::vector<Column> trace_columns();
Table trace_table(Store& store, std::int64_t trial_id);
}  // namespace tapstudy::results
