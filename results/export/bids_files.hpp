#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "results/export/study_export.hpp"
#include "results/store/store.hpp"
namespace tapstudy::results {
// The JSON files of a BIDS dataset.
std::string dataset_description(const Provenance& provenance);
// Of a table: each column's Description, Units, and Levels where they are known.
struct DescribedColumn {
  Column column;
  std::vector<std::pair<std::string, std::string>> levels{};
};
std::string table_sidecar(const std::vector<DescribedColumn>& columns);
// Of a questionnaire: what it is, and its columns.
std::string phenotype_sidecar(const std::string& tool, const std::vector<DescribedColumn>& columns);
std::string task_sidecar(const std::string& task, const BlockText& block,
                         const std::vector<DescribedColumn>& columns);
std::string recording_sidecar(double rate_hz, const std::vector<Column>& columns);

// Labels of the Brain Imaging Data Structure are letters and digits (ASCII).
struct BidsLabels {
  std::map<std::string, std::string> by_name;
  std::vector<std::string> notes;  // what was changed that a reader must know of
};
// Of names, in order. Of a name of letters, digits, '-' and '_' the label is its letters and
// digits; any other name, a person's for instance, is replaced by `substitute` and a number. Labels
// that would be the same, or differ in case alone, get a number.
BidsLabels bids_labels(const std::vector<std::string>& names, const std::string& substitute);

// Of one session, the changes of its state while it was at one block, as an _events.tsv. What
// belongs to no trial (instructions, a pause) is of the block that follows, at the end of the last.
// Onsets are from the session's begin. Why a session stopped or faulted is left out.
struct BlockEvents {
  std::string participant;
  std::int64_t session{};
  std::string block;
  std::string table;
};
std::vector<BlockEvents> events_of_blocks(Store& store);
std::vector<DescribedColumn> event_columns();

// A column of participants.tsv that an item of a questionnaire fills.
struct ParticipantsColumn {
  DescribedColumn column;
  std::map<std::string, std::string> answers;  // the latest, by participant
};
std::vector<ParticipantsColumn> participants_columns(Store& store,
                                                     const std::vector<FormText>& forms);

// A questionnaire as a measurement tool of BIDS, asked at one place of the session.
struct Phenotype {
  std::string name;  // of its files, without ending: letters, digits and '_'
  // A row for each participant who did a trial, as BIDS asks, also where nothing was answered; a
  // column an item. Free text is left out.
  std::string table;
  std::string sidecar;  // JSON: the questions and what their answers mean
};
// Of each questionnaire and each place at which somebody was asked it. labels: of participants.
std::vector<Phenotype> phenotypes(Store& store, const std::vector<FormText>& forms,
                                  const std::map<std::string, std::string>& labels);
}  // namespace tapstudy::results
