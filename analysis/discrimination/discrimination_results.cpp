#include "analysis/discrimination/discrimination_results.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "analysis/discrimination/decision_task.hpp"
#include "analysis/participants/mean_proportion.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using results::AlternativeRow;
using results::AnswerRow;

struct Counts {
  Proportion correct;
  Proportion correct_of_different;
  Proportion correct_of_same;
};

bool is_of_different(const AnswerRow& answer) {
  return std::ranges::any_of(answer.alternatives, [&](const AlternativeRow& alternative) {
    const AlternativeRow& first = answer.alternatives.front();
    return alternative.stimulus != first.stimulus || alternative.axis_values != first.axis_values;
  });
}

std::string stimuli_of(const AnswerRow& answer) {
  std::set<std::string> names;
  for (const AlternativeRow& alternative : answer.alternatives) {
    names.insert(alternative.stimulus);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

void check(const BlockDesign& design) {
  if (!(design.guess_rate > 0.0 && design.guess_rate < 1.0)) {
    throw core::InvalidInput{fmt::format("block '{}': a guess rate is between 0 and 1, not {}",
                                         design.name, design.guess_rate)};
  }
}

void check(const BlockDesign& design, const AnswerRow& answer) {
  if (!answer.is_correct) {
    throw core::InvalidInput{
        fmt::format("block '{}': the answer of {} to trial {} is neither right nor wrong",
                    design.name, answer.participant_id, answer.number)};
  }
}

std::optional<DifferentRates> rates_of(const Counts& counts) {
  if (counts.correct_of_different.trials == 0 || counts.correct_of_same.trials == 0) {
    return std::nullopt;
  }
  DifferentRates rates;
  rates.hits = counts.correct_of_different;
  rates.false_alarms = {counts.correct_of_same.trials - counts.correct_of_same.successes,
                        counts.correct_of_same.trials};
  const double hit_rate = log_linear_rate(rates.hits);
  const double false_alarm_rate = log_linear_rate(rates.false_alarms);
  rates.differencing = same_different_differencing(hit_rate, false_alarm_rate);
  rates.independent = same_different_independent(hit_rate, false_alarm_rate);
  rates.differencing_interval =
      same_different_differencing_interval(rates.hits, rates.false_alarms);
  rates.independent_interval = same_different_independent_interval(rates.hits, rates.false_alarms);
  rates.criterion = yes_no_sensitivity(rates.hits, rates.false_alarms);
  return rates;
}

std::optional<DPrimeOfMean> d_prime_of_mean(const std::vector<Proportion>& correct,
                                            const DecisionTask& task) {
  const auto over = beta_binomial_mean(correct);
  if (!over) {
    return std::nullopt;
  }
  return DPrimeOfMean{
      d_prime_of(task, over->mean),
      {d_prime_of(task, over->interval.low), d_prime_of(task, over->interval.high)}};
}

ParticipantDiscrimination participant_of(const BlockDesign& design, const std::string& name,
                                         const Counts& counts,
                                         const std::optional<DecisionTask>& task) {
  ParticipantDiscrimination person{name, counts.correct, {}, {}, rates_of(counts)};
  if (design.premise.empty()) {
    person.p = binomial_p_at_least(counts.correct, design.guess_rate);
  }
  if (task) {
    person.sensitivity = sensitivity(*task, counts.correct);
  }
  return person;
}

// By their stimuli, then by participant.
using CountsOfPairs = std::map<std::string, std::map<std::string, Proportion>>;

std::vector<DiscriminationResults::Pair> pairs_of(const CountsOfPairs& counts,
                                                  const std::optional<DecisionTask>& task) {
  std::vector<DiscriminationResults::Pair> pairs;
  for (const auto& [stimuli, of_participants] : counts) {
    DiscriminationResults::Pair& pair =
        pairs.emplace_back(DiscriminationResults::Pair{stimuli, {}});
    for (const auto& [name, correct] : of_participants) {
      pair.correct.push_back(correct);
    }
    if (task) {
      pair.d_prime = d_prime_of_mean(pair.correct, *task);
    }
  }
  return pairs;
}
}  // namespace

bool are_same_presented(const std::vector<ParticipantDiscrimination>& people) {
  return std::ranges::any_of(people, [](const auto& person) { return person.rates.has_value(); });
}

std::vector<Proportion> correct_of(const std::vector<ParticipantDiscrimination>& people) {
  std::vector<Proportion> correct;
  std::ranges::transform(people, std::back_inserter(correct), &ParticipantDiscrimination::correct);
  return correct;
}

DiscriminationResults discrimination_results(const BlockDesign& design,
                                             const std::vector<AnswerRow>& answers) {
  check(design);
  const std::optional<DecisionTask> task = decision_task(design);
  std::map<std::string, Counts> people;
  CountsOfPairs pairs;
  DiscriminationResults results;
  results.model = find_decision_model(design.decision_model);
  for (const AnswerRow& answer : answers) {
    check(design, answer);
    Counts& counts = people[answer.participant_id];
    counts.correct.add(*answer.is_correct);
    results.correct.add(*answer.is_correct);
    if (!answer.alternatives.empty()) {
      Proportion& of_kind =
          is_of_different(answer) ? counts.correct_of_different : counts.correct_of_same;
      of_kind.add(*answer.is_correct);
      pairs[stimuli_of(answer)][answer.participant_id].add(*answer.is_correct);
    }
  }
  for (const auto& [name, counts] : people) {
    results.participants.push_back(participant_of(design, name, counts, task));
  }
  results.pairs = pairs_of(pairs, are_same_presented(results.participants) ? std::nullopt : task);
  if (task) {
    results.d_prime_of_mean = d_prime_of_mean(correct_of(results.participants), *task);
  }
  if (design.premise.empty() && results.correct.trials > 0) {
    results.p = binomial_p_at_least(results.correct, design.guess_rate);
  }
  return results;
}
}  // namespace tapstudy::analysis
