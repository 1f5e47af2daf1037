#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include "analysis/answer_tables/answer_columns.hpp"
#include "analysis/statistics/confusion_matrix.hpp"
#include "analysis/statistics/csv_rows.hpp"
#include "results/rows.hpp"
namespace tapstudy::analysis {
struct AnswerReading {
  AnswerColumns columns{};
  std::vector<RowCondition> conditions{};  // rows that fail one are other trials
  // What answers stand for, "1" for acrylic; an answer for itself is one that is no stimulus.
  std::map<std::string, std::string> responses{};
};

// One answer a row, of one question with one right answer: the stimulus's own name.
struct AnswerTable {
  std::vector<results::AnswerRow> answers;  // response_time_s is NaN where it is not known
  std::vector<Item> stimuli;                // by name
  std::vector<Item> responses;              // by name
  std::set<std::string> modes;              // of them, but for real; at most one
  bool are_participants_known{};
  std::size_t rows{};         // that meet the conditions
  std::size_t unanswered{};   // of these: left out, for the answer is empty, NA, None or null
  std::size_t not_counted{};  // likewise: tapstudy's own practice, catch trials, excluded people …
  // Likewise: where some are of real sessions, those of others; else, if some are pilots,
  // simulated.
  std::size_t of_other_modes{};
  bool has_times{};
  std::string possible_time{};  // a column that was not read, but may hold times; empty: none
};

struct NamedCsv {
  std::string file;  // also the participant's name, if no column has it and there are several files
  CsvText text;
};
// Participants' answers follow one another as rows and files do. Throws InvalidInput with file:line
// for an answer that is neither a stimulus nor one of `responses`, a time that is no number from 0,
// an answer without a stimulus, several blocks of one of tapstudy's own exports, a row with more or
// fewer cells than the header, more than 200 different answers, or no answers at all.
AnswerTable read_answers(const std::vector<NamedCsv>& files, const AnswerReading& reading);
}  // namespace tapstudy::analysis
