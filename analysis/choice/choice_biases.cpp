#include "analysis/choice/choice_biases.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "analysis/statistics/log_factorial.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using results::AlternativeRow;
using results::AnswerRow;

std::optional<std::size_t> chosen_position(const AnswerRow& answer) {
  const auto found =
      std::ranges::find(answer.alternatives, answer.response, &AlternativeRow::stimulus);
  return found == answer.alternatives.end()
             ? std::nullopt
             : std::optional{static_cast<std::size_t>(found - answer.alternatives.begin())};
}

void count_visited(const VisitOrder& order, std::size_t chosen, std::size_t alternatives,
                   ChoiceBiases& biases) {
  const std::set<int> visited(order.positions.begin(), order.positions.end());
  if (visited.size() < alternatives) {
    return;
  }
  const int position = static_cast<int>(chosen);
  biases.first_visited.add(order.positions.front() == position);
  biases.last_visited.add(order.positions.back() == position);
}

std::map<std::int64_t, const VisitOrder*> by_trial(const BlockRows& rows) {
  std::map<std::int64_t, const VisitOrder*> orders;
  for (const VisitOrder& order : rows.orders) {
    orders[order.trial_id] = &order;
  }
  return orders;
}
}  // namespace

ChoiceBiases choice_biases(const BlockRows& rows) {
  ChoiceBiases biases;
  const auto orders = by_trial(rows);
  for (const AnswerRow& answer : rows.answers) {
    const std::optional<std::size_t> chosen = chosen_position(answer);
    if (!chosen) {
      continue;
    }
    if (biases.labels.empty()) {
      for (const AlternativeRow& alternative : answer.alternatives) {
        biases.labels.push_back(alternative.label);
      }
      biases.chosen.assign(biases.labels.size(), 0);
      biases.chance = 1.0 / static_cast<double>(biases.labels.size());
    }
    if (answer.alternatives.size() != biases.labels.size()) {
      throw core::InvalidInput{"block '" + answer.block +
                               "': trials differ in their number of alternatives"};
    }
    ++biases.chosen[*chosen];
    if (const auto order = orders.find(answer.trial_id); order != orders.end()) {
      count_visited(*order->second, *chosen, biases.labels.size(), biases);
    }
  }
  if (!biases.chosen.empty()) {
    biases.labels_p = exact_multinomial_p(biases.chosen);
  }
  return biases;
}

std::vector<std::vector<std::int64_t>> transitions(const std::vector<Item>& stimuli,
                                                   const BlockRows& rows) {
  std::vector<std::vector<std::int64_t>> counts(stimuli.size(),
                                                std::vector<std::int64_t>(stimuli.size(), 0));
  const auto orders = by_trial(rows);
  for (const AnswerRow& answer : rows.answers) {
    const auto order = orders.find(answer.trial_id);
    if (order == orders.end()) {
      continue;
    }
    std::vector<std::size_t> visited;
    for (const int position : order->second->positions) {
      const std::string& name = answer.alternatives.at(static_cast<std::size_t>(position)).stimulus;
      visited.push_back(static_cast<std::size_t>(std::ranges::find(stimuli, name, &Item::name) -
                                                 stimuli.begin()));
    }
    for (std::size_t i = 1; i < visited.size(); ++i) {
      if (visited[i - 1] < stimuli.size() && visited[i] < stimuli.size()) {
        ++counts[visited[i - 1]][visited[i]];
      }
    }
  }
  return counts;
}

double binomial_two_sided_p(const Proportion& observed, double chance) {
  constexpr double rounding = 1e-7;  // outcomes so close in probability are equally likely
  const auto log_probability = [&](std::int64_t k) {
    const std::int64_t n = observed.trials;
    return log_factorial(n) - log_factorial(k) - log_factorial(n - k) +
           static_cast<double>(k) * std::log(chance) +
           static_cast<double>(n - k) * std::log1p(-chance);
  };
  const double limit = log_probability(observed.successes) + rounding;
  double p = 0.0;
  for (std::int64_t k = 0; k <= observed.trials; ++k) {
    const double probability = log_probability(k);
    p += probability <= limit ? std::exp(probability) : 0.0;
  }
  return std::min(1.0, p);
}
}  // namespace tapstudy::analysis
