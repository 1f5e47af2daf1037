#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/psychometric_function.hpp"
namespace tapstudy::protocols {
// A parameter's grid. A nuisance is estimated, but stimuli are not chosen to learn about it (Prins
// 2013).
struct ParameterGrid {
  std::string name;
  std::vector<double> values;   // increasing
  std::vector<double> weights;  // prior of each, at least 0, not all 0; they need not sum to 1
  bool is_nuisance{false};
};

// Probability of each outcome, for the values of a stimulus on its axes and of the parameters in
// the order of their grids.
using OutcomeModel =
    std::function<void(std::span<const double> stimulus, std::span<const double> parameters,
                       std::span<double> probabilities)>;

struct QuestPlusDesign {
  std::vector<std::vector<double>> axes;  // values of the stimulus on each
  std::vector<ParameterGrid> parameters;
  std::size_t outcomes{2};
  OutcomeModel model;
};

// Probability of every outcome of every stimulus under every combination of parameters (Watson
// 2017, eq. 1). Stimuli count with the last axis fastest. Combinations count with nuisances
// fastest, so that those that differ by nuisances alone are adjacent; otherwise in the order of the
// grids, the last fastest.
class LikelihoodTable {
 public:
  // 40 MB; choosing a stimulus then takes tens of milliseconds.
  static constexpr std::size_t max_entries = 5'000'000;

  // Throws InvalidInput for empty grids, weights that are negative or all 0, a table that is too
  // large, nothing to estimate, probabilities that are none, and where answers could exclude every
  // combination of the prior: one of them must allow every outcome of every stimulus.
  explicit LikelihoodTable(QuestPlusDesign design);

  const QuestPlusDesign& design() const { return design_; }
  std::size_t stimuli() const { return stimuli_.size(); }
  std::size_t combinations() const { return prior_.size(); }
  // Combinations in a row that differ by nuisances alone.
  std::size_t nuisance_combinations() const { return nuisance_combinations_; }
  const std::vector<double>& stimulus(std::size_t index) const { return stimuli_.at(index); }
  // Value of each parameter, in the order of their grids.
  std::span<const double> combination(std::size_t index) const;
  const std::vector<double>& prior() const { return prior_; }  // sums to 1
  // Of each stimulus.
  std::span<const double> likelihoods(std::size_t combination, std::size_t outcome) const;
  // Of each combination, at a stimulus that may be off the grid.
  std::vector<double> likelihoods_at(const std::vector<double>& stimulus,
                                     std::size_t outcome) const;

 private:
  void check_grids() const;
  void list_stimuli();
  void list_combinations();
  void compute();
  void check_possible() const;
  std::vector<double> probabilities(const std::vector<double>& stimulus, std::size_t index) const;

  QuestPlusDesign design_;
  std::size_t nuisance_combinations_{1};
  std::vector<std::vector<double>> stimuli_;
  std::vector<double> parameters_;  // of each combination in turn
  std::vector<double> prior_;
  std::vector<double> entries_;
};

// Two outcomes, 1 with the probability psi of a psychometric function of the first axis, whose
// threshold the further axes x2, x3, ... move (Watson 2017 so models contrast sensitivity):
//   on a linear axis of the shape  threshold + effect2 (x2 - o2) + effect3 (x3 - o3) + ...
//   on its log10 axis              threshold 10^(effect2 (x2 - o2) + effect3 (x3 - o3) + ...)
// where o2, o3, ... are origins, one for each further axis.
// Parameters in this order: threshold, slope, guess, lapse, then an effect for each further axis.
// The model throws InvalidInput where the psychometric function does.
OutcomeModel psychometric_model(core::PsychometricShape shape, std::vector<double> origins);
}  // namespace tapstudy::protocols
