#include "analysis/report/study/confidence.hpp"

#include <fmt/format.h>

#include <map>
#include <set>

#include "analysis/report/document/wording.hpp"
namespace tapstudy::analysis {
namespace {
// Of one step.
struct Given {
  std::int64_t answers{};
  std::set<std::string> participants;
  std::map<std::string, Proportion>
      right;  // of each participant; of answers that are right or wrong
};

std::map<int, Given> given_in(const std::string& block,
                              const std::vector<results::AnswerRow>& answers) {
  std::map<int, Given> steps;
  for (const results::AnswerRow& answer : answers) {
    if (answer.block != block || !answer.confidence) {
      continue;
    }
    Given& step = steps[*answer.confidence];
    ++step.answers;
    step.participants.insert(answer.participant_id);
    if (answer.is_correct) {
      step.right[answer.participant_id].add(*answer.is_correct);
    }
  }
  return steps;
}

std::string meaning_of(int step, const ConfidenceScale& scale) {
  return step == 1 ? scale.low : step == scale.steps ? scale.high : "";
}

std::vector<Proportion> listed(const std::map<std::string, Proportion>& of_participants) {
  std::vector<Proportion> all;
  for (const auto& [participant, right] : of_participants) {
    all.push_back(right);
  }
  return all;
}
}  // namespace

ReportSection confidence_section(const std::vector<ConfidenceScale>& scales,
                                 const std::vector<results::AnswerRow>& answers) {
  ReportTable table{"confidence",
                    "How sure participants were of their answers",
                    {column("block", "block"), column("confidence", "confidence"),
                     column("means", "meaning"), column("answers", "answers"),
                     column("participants", "participants"), proportion_column("right", "right")}};
  for (const ConfidenceScale& scale : scales) {
    for (const auto& [step, given] : given_in(scale.block, answers)) {
      table.rows.push_back({word(scale.block), count(step), word(meaning_of(step, scale)),
                            count(given.answers), count(std::ssize(given.participants)),
                            given.right.empty() ? nothing(table.columns.back())
                                                : pooled_proportion(listed(given.right))});
    }
  }
  ReportSection section{"Confidence"};
  if (!table.rows.empty()) {
    section.name = study_sections::confidence;
    section.tables.push_back(std::move(table));
    section.remarks.emplace_back(
        "Of the answers that count, with the confidence given with them. Descriptive: whoever is "
        "seldom sure weighs little in the upper rows.");
  }
  return section;
}
}  // namespace tapstudy::analysis
