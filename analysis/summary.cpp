#include "analysis/summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "analysis/permutation_test.hpp"
namespace tapstudy::analysis {
namespace {
using results::AnswerRow;
constexpr int most_shuffles = 9999;
constexpr int fewest_shuffles = 99;
constexpr std::uint64_t shuffle_seed = 1;

// As many as take no more than a moment; the report says how many there were.
int shuffles_for(std::size_t answers) {
  constexpr std::size_t most_work = 20'000'000;
  return static_cast<int>(std::clamp<std::size_t>(most_work / std::max<std::size_t>(answers, 1),
                                                  fewest_shuffles, most_shuffles));
}

std::vector<FactorResult> factor_results(const ConfusionMatrix& matrix) {
  std::vector<FactorResult> found;
  const std::vector<std::string> factors = factors_of(matrix);
  for (const std::string& factor : factors) {
    found.push_back(
        {factor, "", factor_accuracy(matrix, factor), factor_chance(matrix, factor, "")});
  }
  for (const std::string& factor : factors) {
    for (const std::string& given : factors) {
      if (factor != given) {
        found.push_back({factor, given, conditional_accuracy(matrix, factor, given),
                         factor_chance(matrix, factor, given)});
      }
    }
  }
  return found;
}

IdentificationSummary summary_of(const ConfusionMatrix& matrix, const std::string& block,
                                 const std::string& question) {
  return {block, question, matrix, overall_accuracy(matrix), factor_results(matrix), {}, {}};
}

IdentificationSummary identification(const BlockDesign& design,
                                     const std::vector<AnswerRow>& answers) {
  ConfusionMatrix matrix{design.stimuli, design.responses};
  std::map<std::string, Proportion> accuracies;
  std::map<std::string, Answers> by_participant;
  std::vector<std::string> order;
  std::map<std::string, int> codes;
  const auto code = [&](const std::string& name) {
    return codes.emplace(name, static_cast<int>(codes.size())).first->second;
  };
  for (const AnswerRow& answer : answers) {
    matrix.add(answer.stimulus, answer.response);
    if (!accuracies.contains(answer.participant_id)) {
      order.push_back(answer.participant_id);
    }
    Proportion& accuracy = accuracies[answer.participant_id];
    ++accuracy.trials;
    accuracy.successes += answer.stimulus == answer.response ? 1 : 0;
    by_participant[answer.participant_id].stimuli.push_back(code(answer.stimulus));
    by_participant[answer.participant_id].responses.push_back(code(answer.response));
  }
  IdentificationSummary summary = summary_of(matrix, design.name, design.question);
  std::vector<Answers> all;
  for (const std::string& participant : order) {
    summary.participants.push_back({participant, accuracies[participant]});
    all.push_back(by_participant[participant]);
  }
  if (design.hypotheses.empty()) {
    return summary;
  }
  const int shuffles = shuffles_for(answers.size());
  const double p = permutation_p(all, shuffles, shuffle_seed);
  for (const PlannedHypothesis& planned : design.hypotheses) {
    summary.hypotheses.push_back(
        {planned, fmt::format("permutation within participants, {} shuffles, one-sided", shuffles),
         summary.accuracy, matrix.chance(), p});
  }
  return summary;
}

ChoiceSummary choice(const BlockDesign& design, const std::vector<AnswerRow>& answers,
                     const std::vector<results::VisitRow>& visits) {
  ChoiceSummary summary{design.name, design.question, {}, {}, std::nullopt, false, {}};
  std::vector<int> counts;
  const int total = static_cast<int>(answers.size());
  for (const Item& item : design.stimuli) {
    AlternativeResult result{item, {0, total}, 0, 0.0};
    result.chosen.successes =
        static_cast<int>(std::ranges::count(answers, item.name, &AnswerRow::response));
    for (const results::VisitRow& visit : visits) {
      if (visit.block == design.name && visit.stimulus == item.name) {
        result.visits += visit.visits;
        result.dwell_s += visit.dwell_s;
      }
    }
    counts.push_back(result.chosen.successes);
    summary.alternatives.push_back(result);
  }
  std::set<std::string> seen;
  for (const AnswerRow& answer : answers) {
    summary.choices.emplace_back(answer.participant_id, answer.response);
    summary.has_repeated_choices |= !seen.insert(answer.participant_id).second;
  }
  summary.multinomial_p = exact_multinomial_p(counts);
  const double chance = 1.0 / static_cast<double>(design.stimuli.size());
  for (const PlannedHypothesis& planned : design.hypotheses) {
    const auto expected = std::ranges::find_if(
        summary.alternatives,
        [&](const AlternativeResult& result) { return result.item.name == planned.stimulus; });
    summary.hypotheses.push_back({planned, "exact binomial, one-sided", expected->chosen, chance,
                                  binomial_p_at_least(expected->chosen, chance)});
  }
  return summary;
}

LoopQuality loop_quality(const std::vector<AnswerRow>& answers) {
  LoopQuality quality;
  for (const AnswerRow& answer : answers) {
    quality.ticks += answer.ticks;
    quality.late += answer.late;
    quality.skipped += answer.skipped;
    quality.dropped_samples += answer.dropped_samples;
  }
  return quality;
}
}  // namespace

Summary summarise(const StudyDesign& design, const std::vector<AnswerRow>& answers,
                  const std::vector<results::VisitRow>& visits) {
  Summary summary;
  summary.title = design.title;
  summary.notes = design.notes;
  std::set<std::string> modes;
  std::set<std::string> participants;
  for (const AnswerRow& answer : answers) {
    modes.insert(results::to_text(answer.mode));
    participants.insert(answer.participant_id);
  }
  summary.modes = fmt::format("{}", fmt::join(modes, ", "));
  summary.participants = static_cast<int>(participants.size());
  summary.loop = loop_quality(answers);
  for (const BlockDesign& block : design.blocks) {
    std::vector<AnswerRow> own;
    std::ranges::copy_if(answers, std::back_inserter(own),
                         [&](const AnswerRow& answer) { return answer.block == block.name; });
    summary.blocks.push_back(block.is_choice ? BlockSummary{choice(block, own, visits)}
                                             : BlockSummary{identification(block, own)});
  }
  return summary;
}

Summary summarise(const ConfusionMatrix& matrix, const std::string& title) {
  Summary summary;
  summary.title = title;
  summary.modes = "counts";
  summary.blocks.emplace_back(summary_of(matrix, "", ""));
  return summary;
}
}  // namespace tapstudy::analysis
