#pragma once
#include <string>
#include <vector>

#include "analysis/report/answer_tables/answer_checks.hpp"
#include "analysis/report/answer_tables/answer_table.hpp"
namespace tapstudy::analysis {
// The columns that hold neither stimuli nor answers nor what else is read of a file, and its
// header.
struct OtherColumns {
  const NamedCsv* csv{};
  std::vector<std::string> header{};
  std::vector<std::size_t> places{};
  std::string weight{};    // by its name or as asked for; empty: none
  std::string response{};  // where the answers are
  bool has_times{};        // a column that is read, or may be
};

// Whether each kind of answer (participant, stimulus, response) has one row.
bool is_counted_already(const std::vector<results::AnswerRow>& answers);

// Each answer as often as its row says, if rows say it; table.weight_column is that column. A table
// that was counted has one row for each kind of answer. Throws InvalidInput where it is not clear
// whether a column counts answers, where rows of some files say it and those of others do not,
// where a column holds shares, where one row sums up others, for more than a million answers and
// none at all.
void weigh_answers(const std::vector<OtherColumns>& files, const AnswerReading& reading,
                   AnswerTable& table, AnswerOrigins& origins);
}  // namespace tapstudy::analysis
