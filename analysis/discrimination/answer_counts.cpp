#include "analysis/discrimination/answer_counts.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

#include "core/error.hpp"
namespace tapstudy::analysis {
std::optional<DecisionTask> decision_task(const BlockDesign& design) {
  if (design.decision_model.empty()) {
    return std::nullopt;
  }
  const DecisionModelRow* const row = find_decision_model(design.decision_model);
  if (row == nullptr) {
    throw core::InvalidInput{fmt::format("block '{}': there is no decision model '{}'", design.name,
                                         design.decision_model)};
  }
  const DecisionTask task{row->model, static_cast<int>(std::lround(1.0 / design.guess_rate))};
  constexpr double tolerance = 1e-6;
  if (std::abs(chance(task) - design.guess_rate) > tolerance) {
    throw core::InvalidInput{fmt::format("block '{}': {} has no guess rate of {}", design.name,
                                         row->name, design.guess_rate)};
  }
  return task;
}

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
