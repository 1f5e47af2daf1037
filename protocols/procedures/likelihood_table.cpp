#include "protocols/procedures/likelihood_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/error.hpp"
namespace tapstudy::protocols {
OutcomeModel psychometric_model(core::PsychometricShape shape, std::vector<double> origins) {
  const bool is_logarithmic = core::row_of(shape).is_logarithmic;
  return [shape, is_logarithmic, origins = std::move(origins)](std::span<const double> stimulus,
                                                               std::span<const double> parameters,
                                                               std::span<double> probabilities) {
    double shift = 0.0;
    for (std::size_t i = 0; i < origins.size(); ++i) {
      shift += parameters[4 + i] * (stimulus[1 + i] - origins[i]);
    }
    const double threshold =
        is_logarithmic ? parameters[0] * std::pow(10.0, shift) : parameters[0] + shift;
    probabilities[1] = core::proportion(shape, stimulus[0], threshold, parameters[1], parameters[2],
                                        parameters[3]);
    probabilities[0] = 1.0 - probabilities[1];
  };
}

namespace {
// All ways to take one of each, the last fastest.
template <typename Take>
void for_every_choice(const std::vector<std::size_t>& sizes, Take&& take) {
  std::vector<std::size_t> choice(sizes.size(), 0);
  std::size_t place = 0;
  do {
    take(choice);
    place = sizes.size();
    while (place > 0 && ++choice[place - 1] == sizes[place - 1]) {
      choice[--place] = 0;
    }
  } while (place > 0);
}

void check_weights(const ParameterGrid& grid) {
  if (grid.values.empty() || grid.weights.size() != grid.values.size()) {
    throw core::InvalidInput{fmt::format("{}: has {} values and {} weights instead of as many",
                                         grid.name, grid.values.size(), grid.weights.size())};
  }
  const double sum = std::accumulate(grid.weights.begin(), grid.weights.end(), 0.0);
  if (std::ranges::any_of(grid.weights, [](double weight) { return !(weight >= 0.0); }) ||
      !(sum > 0.0) || !std::isfinite(sum)) {
    throw core::InvalidInput{fmt::format(
        "{}: the prior excludes every value (weights are at least 0 and not all 0)", grid.name)};
  }
}
}  // namespace

LikelihoodTable::LikelihoodTable(QuestPlusDesign design) : design_{std::move(design)} {
  check_grids();
  list_stimuli();
  list_combinations();
  compute();
  check_possible();
}

void LikelihoodTable::check_grids() const {
  double entries = static_cast<double>(design_.outcomes);
  bool is_anything_to_learn = false;
  for (const std::vector<double>& axis : design_.axes) {
    entries *= static_cast<double>(axis.size());
  }
  for (const ParameterGrid& grid : design_.parameters) {
    check_weights(grid);
    entries *= static_cast<double>(grid.values.size());
    const bool is_open = std::ranges::count_if(grid.weights, [](double w) { return w > 0.0; }) > 1;
    is_anything_to_learn = is_anything_to_learn || (is_open && !grid.is_nuisance);
  }
  if (entries < 2.0 || design_.axes.empty() || design_.outcomes < 2) {
    throw core::InvalidInput{"a procedure needs stimuli, and at least two outcomes"};
  }
  if (!is_anything_to_learn) {
    throw core::InvalidInput{
        "there is nothing to estimate: each parameter has one possible value or is a nuisance"};
  }
  if (entries > static_cast<double>(max_entries)) {
    throw core::InvalidInput{fmt::format(
        "the grids make {:.0f} likelihoods (stimuli times parameter combinations times outcomes), "
        "at most {} are allowed: use fewer values",
        entries, max_entries)};
  }
}

void LikelihoodTable::list_stimuli() {
  std::vector<std::size_t> sizes;
  std::ranges::transform(design_.axes, std::back_inserter(sizes), &std::vector<double>::size);
  for_every_choice(sizes, [&](const std::vector<std::size_t>& choice) {
    std::vector<double>& stimulus = stimuli_.emplace_back();
    for (std::size_t axis = 0; axis < choice.size(); ++axis) {
      stimulus.push_back(design_.axes[axis][choice[axis]]);
    }
  });
}

void LikelihoodTable::list_combinations() {
  std::vector<std::size_t> order(design_.parameters.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_partition(order.begin(), order.end(), [&](std::size_t parameter) {
    return !design_.parameters[parameter].is_nuisance;
  });
  std::vector<std::size_t> sizes;
  for (const std::size_t parameter : order) {
    const ParameterGrid& grid = design_.parameters[parameter];
    sizes.push_back(grid.values.size());
    nuisance_combinations_ *= grid.is_nuisance ? grid.values.size() : 1;
  }
  for_every_choice(sizes, [&](const std::vector<std::size_t>& choice) {
    std::vector<double> combination(order.size());
    double weight = 1.0;
    for (std::size_t place = 0; place < order.size(); ++place) {
      const ParameterGrid& grid = design_.parameters[order[place]];
      combination[order[place]] = grid.values[choice[place]];
      weight *= grid.weights[choice[place]];
    }
    parameters_.insert(parameters_.end(), combination.begin(), combination.end());
    prior_.push_back(weight);
  });
  const double sum = std::accumulate(prior_.begin(), prior_.end(), 0.0);
  if (!(sum > 0.0) || !std::isfinite(sum)) {
    throw core::InvalidInput{"the priors of the parameters exclude every combination"};
  }
  std::ranges::for_each(prior_, [&](double& weight) { weight /= sum; });
}

std::span<const double> LikelihoodTable::combination(std::size_t index) const {
  const std::size_t size = design_.parameters.size();
  return {&parameters_.at(index * size), size};
}

std::vector<double> LikelihoodTable::probabilities(const std::vector<double>& stimulus,
                                                   std::size_t index) const {
  std::vector<double> each(design_.outcomes);
  design_.model(stimulus, combination(index), each);
  const double sum = std::accumulate(each.begin(), each.end(), 0.0);
  if (std::ranges::any_of(each, [](double p) { return !(p >= 0.0 && p <= 1.0); }) ||
      std::abs(sum - 1.0) > 1e-9) {
    throw core::InvalidInput{"the model's probabilities of the outcomes do not sum to 1"};
  }
  return each;
}

void LikelihoodTable::compute() {
  entries_.resize(combinations() * design_.outcomes * stimuli());
  for (std::size_t combination = 0; combination < combinations(); ++combination) {
    for (std::size_t stimulus = 0; stimulus < stimuli(); ++stimulus) {
      const std::vector<double> each = probabilities(stimuli_[stimulus], combination);
      for (std::size_t outcome = 0; outcome < each.size(); ++outcome) {
        entries_[(combination * design_.outcomes + outcome) * stimuli() + stimulus] = each[outcome];
      }
    }
  }
}

void LikelihoodTable::check_possible() const {
  const std::size_t size = design_.outcomes * stimuli();
  for (std::size_t combination = 0; combination < combinations(); ++combination) {
    const std::span<const double> own{&entries_[combination * size], size};
    if (prior_[combination] > 0.0 && std::ranges::all_of(own, [](double p) { return p > 0.0; })) {
      return;
    }
  }
  throw core::InvalidInput{
      "an answer could exclude every combination of the parameters, as each makes some outcome "
      "impossible: allow guess and lapse rates above 0"};
}

std::span<const double> LikelihoodTable::likelihoods(std::size_t combination,
                                                     std::size_t outcome) const {
  return {&entries_.at((combination * design_.outcomes + outcome) * stimuli()), stimuli()};
}

std::vector<double> LikelihoodTable::likelihoods_at(const std::vector<double>& stimulus,
                                                    std::size_t outcome) const {
  std::vector<double> all;
  for (std::size_t combination = 0; combination < combinations(); ++combination) {
    all.push_back(probabilities(stimulus, combination).at(outcome));
  }
  return all;
}
}  // namespace tapstudy::protocols
