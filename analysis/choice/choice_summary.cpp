#include "analysis/choice/choice_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/error.hpp"
namespace tapstudy::analysis {
std::shared_ptr<const BlockSummary> summarise_choice(const BlockDesign& design,
                                                     const BlockRows& rows) {
  const std::vector<results::AnswerRow>& answers = rows.answers;
  auto result_of_block = std::make_shared<ChoiceSummary>(design.name, design.question);
  ChoiceSummary& summary = *result_of_block;
  summary.task = design.task;
  std::vector<int> counts;
  const int total = static_cast<int>(answers.size());
  for (const Item& item : design.stimuli) {
    AlternativeResult result{item, {0, total}, 0, 0.0};
    result.chosen.successes =
        static_cast<int>(std::ranges::count(answers, item.name, &results::AnswerRow::response));
    for (const results::VisitRow& visit : rows.visits) {
      if (visit.stimulus == item.name) {
        result.visits += visit.visits;
        result.dwell_s += visit.dwell_s;
      }
    }
    counts.push_back(result.chosen.successes);
    summary.alternatives.push_back(result);
  }
  std::set<std::string> seen;
  for (const results::AnswerRow& answer : answers) {
    summary.choices.emplace_back(answer.participant_id, answer.response);
    summary.has_repeated_choices |= !seen.insert(answer.participant_id).second;
  }
  summary.multinomial_p = exact_multinomial_p(counts);
  const double chance = 1.0 / static_cast<double>(design.stimuli.size());
  for (const PlannedHypothesis& planned : design.hypotheses) {
    const auto expected = std::ranges::find_if(
        summary.alternatives,
        [&](const AlternativeResult& result) { return result.item.name == planned.stimulus; });
    if (expected == summary.alternatives.end()) {
      throw core::InvalidInput{fmt::format(
          "block '{}': hypothesis '{}' names no stimulus of the block", design.name, planned.name)};
    }
    summary.hypotheses.push_back({planned, "exact binomial, one-sided", expected->chosen, chance,
                                  binomial_p_at_least(expected->chosen, chance)});
  }
  return result_of_block;
}
}  // namespace tapstudy::analysis
