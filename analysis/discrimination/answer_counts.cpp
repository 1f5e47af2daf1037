#include "analysis/discrimination/answer_counts.hpp"

#include <map>
#include <set>
#include <string>
namespace tapstudy::analysis {
ReportTable answer_counts_table(const std::vector<results::AnswerRow>& answers) {
  std::set<std::string> given;
  std::map<std::string, std::map<std::string, std::int64_t>> counts;
  std::map<std::string, std::int64_t> all;
  for (const results::AnswerRow& answer : answers) {
    given.insert(answer.response);
    ++counts[answer.participant_id][answer.response];
    ++all[answer.participant_id];
  }
  ReportTable table{"answer_counts",
                    "Answers that were given, each right equally often (bias)",
                    {column("participant", "participant_id")}};
  for (const std::string& answer : given) {
    table.columns.push_back(proportion_column(answer, "given_" + answer));
  }
  for (auto& [participant, by_answer] : counts) {
    table.rows.push_back({word(participant)});
    for (const std::string& answer : given) {
      table.rows.back().push_back(proportion({by_answer[answer], all[participant]}));
    }
  }
  return table;
}
}  // namespace tapstudy::analysis
