#include "analysis/identification/identification_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "analysis/statistics/permutation_test.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using results::AnswerRow;
constexpr int max_shuffles = 9999;
constexpr int min_shuffles = 99;
constexpr std::uint64_t shuffle_seed = 1;

// As many as can be computed quickly; the report states the number.
int shuffles_for(std::size_t answers) {
  constexpr std::size_t max_work = 20'000'000;
  return static_cast<int>(std::clamp<std::size_t>(max_work / std::max<std::size_t>(answers, 1),
                                                  min_shuffles, max_shuffles));
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
}  // namespace

IdentificationSummary::IdentificationSummary(std::string block_name, std::string question_asked,
                                             ConfusionMatrix counted)
    : BlockSummary{std::move(block_name), std::move(question_asked)},
      matrix{std::move(counted)},
      accuracy{overall_accuracy(matrix)},
      factors{factor_results(matrix)} {}

std::shared_ptr<const BlockSummary> summarise_identification(const BlockDesign& design,
                                                             const BlockRows& rows) {
  const std::vector<AnswerRow>& answers = rows.answers;
  ConfusionMatrix matrix{design.stimuli, design.responses};
  std::map<std::string, Proportion> accuracies;
  std::map<std::string, Answers> by_participant;
  std::vector<std::string> order;
  std::map<std::string, int> codes;
  const auto code = [&](const std::string& name) {
    return codes.emplace(name, static_cast<int>(codes.size())).first->second;
  };
  for (const AnswerRow& answer : answers) {
    if (!answer.is_correct) {
      throw core::InvalidInput{
          fmt::format("block '{}': the answer of {} to trial {} is neither right "
                      "nor wrong",
                      design.name, answer.participant_id, answer.number)};
    }
    if (*answer.is_correct != (answer.response == answer.stimulus)) {
      throw core::InvalidInput{fmt::format(
          "block '{}': the answer of {} to trial {} is stored as {}, which a confusion "
          "matrix of '{}' answered '{}' contradicts",
          design.name, answer.participant_id, answer.number,
          *answer.is_correct ? "correct" : "incorrect", answer.stimulus, answer.response)};
    }
    matrix.add(answer.stimulus, answer.response);
    if (!accuracies.contains(answer.participant_id)) {
      order.push_back(answer.participant_id);
    }
    Proportion& accuracy = accuracies[answer.participant_id];
    ++accuracy.trials;
    accuracy.successes += *answer.is_correct ? 1 : 0;
    by_participant[answer.participant_id].stimuli.push_back(code(answer.stimulus));
    by_participant[answer.participant_id].responses.push_back(code(answer.response));
  }
  auto summary =
      std::make_shared<IdentificationSummary>(design.name, design.question, std::move(matrix));
  summary->task = design.task;
  std::vector<Answers> all;
  for (const std::string& participant : order) {
    summary->participants.push_back({participant, accuracies[participant]});
    all.push_back(by_participant[participant]);
  }
  if (design.hypotheses.empty()) {
    return summary;
  }
  const int shuffles = shuffles_for(answers.size());
  const double p = permutation_p(all, shuffles, shuffle_seed);
  for (const PlannedHypothesis& planned : design.hypotheses) {
    summary->hypotheses.push_back(
        {planned, fmt::format("permutation within participants, {} shuffles, one-sided", shuffles),
         summary->accuracy, summary->matrix.chance(), p});
  }
  return summary;
}
}  // namespace tapstudy::analysis
