#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "results/export/csvw.hpp"
#include "results/export/table.hpp"
#include "results/store.hpp"
namespace tapstudy::results {
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
};

// Fills a directory: a file NAME.csv a table, csv-metadata.json (csvw.hpp), protocol.yaml, and of
// each trial that has a trace traces/trial_000001.csv. Throws InvalidInput where it cannot be
// written, StoreError where the study cannot be read.
void write_csv_files(const std::string& directory, Store& store, const StudyExport& study);

// Writes one new HDF5 file. Errors as above.
//   /protocol            its text
//   /tables/NAME/COLUMN  a dataset a column, one-dimensional; attributes unit, description. Missing
//                        numbers are NaN (a column of integers with missing ones is one of
//                        doubles), missing texts "NA"
//   /traces/trial_000001 ticks x columns, doubles; attributes trial_id, columns, units,
//   descriptions
void write_hdf5_file(const std::string& name, Store& store, const StudyExport& study);

// Fills a directory with a dataset of the Brain Imaging Data Structure (BIDS 1.8, behaviour):
// participants.tsv, phenotype/*.tsv with a row a participant, sub-*/[ses-*/]beh/*_beh.tsv with a
// row a trial, *_events.tsv with a row a change of the session's state, *_physio.tsv.gz with each
// trial's trace, JSON beside them. Names that are no labels do not appear (bids_labels.hpp), nor do
// notes, reasons and free text. Errors as above.
void write_bids_dataset(const std::string& directory, Store& store, const StudyExport& study);
}  // namespace tapstudy::results
