// procedures_bench [RUNS]: what each procedure makes of the same simulated observers, two
// alternatives, threshold 1, slope 3.5, 2 % lapses. Thresholds are estimated as reports do, by
// maximum likelihood from all answers, and as the procedure itself does: mean of its last
// reversals, or of its posterior. Prints for each procedure its trials, how many runs have a
// threshold, bias and standard deviation in decibels, and trials times variance relative to the
// first, of the report's estimates and of its own: how many trials it takes for the same spread
// (Taylor & Creelman 1967, sweat factor).
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <map>

#include "analysis/statistics/psychometric/inference.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "support/procedures.hpp"
using namespace tapstudy;

namespace {
constexpr testing::KnownObserver::Parameters of_observer{core::PsychometricShape::weibull, 1.0, 3.5,
                                                         0.5, 0.02};

constexpr const char* of_grid =
    "function: weibull, stimulus: {min: 0.1, max: 10, count: 41, spacing: log}, threshold: {min: "
    "0.1, max: 10, count: 41, spacing: log}, slope: {values: [1, 2, 3.5, 5]}, stop: {trials: 60}";
const std::vector<std::pair<std::string, std::string>>& procedures() {
  static const std::string steps =
      "steps: factor, start: 3, min: 0.1, max: 10, first_step: 1.6, min_step: 1.15, stop: "
      "{trials: 60}, estimate_reversals: 6}";
  static const std::vector<std::pair<std::string, std::string>> all{
      {"QUEST+",
       fmt::format("quest_plus: {{{}, guess: {{values: [0.5]}}, lapse: {{values: [0.02, 0.05]}}}}",
                   of_grid)},
      {"psi", fmt::format("psi: {{{}, guess: 0.5, lapse: 0.02}}", of_grid)},
      {"staircase, 1 up 2 down", "staircase: {rule: transformed, n_down: 2, " + steps},
      {"staircase, 1 up 3 down", "staircase: {rule: transformed, n_down: 3, " + steps},
      {"staircase, weighted to 75 %", "staircase: {rule: weighted, target: 0.75, " + steps},
      {"constant stimuli, near",
       "constant: {min: 0.5, max: 2, count: 6, spacing: log, repetitions: 10}"},
      {"constant stimuli, far",
       "constant: {min: 0.1, max: 10, count: 6, spacing: log, repetitions: 10}"}};
  return all;
}

struct Run {
  std::vector<analysis::Level> levels;
  std::optional<double> own_estimate;
};
Run answered(const protocols::TrackSettings& settings, std::uint64_t seed) {
  testing::KnownObserver observer{of_observer, seed};
  std::map<double, analysis::Proportion> counts;
  const auto track = settings.start(seed);
  testing::run(*track, [&](const std::vector<double>& values) {
    const std::size_t answer = observer.answer(values[0]);
    analysis::Proportion& at = counts[values[0]];
    ++at.trials;
    at.successes += static_cast<std::int64_t>(answer);
    return answer;
  });
  std::vector<analysis::Level> levels;
  for (const auto& [value, of] : counts) {
    levels.push_back({value, of});
  }
  return {levels, track->summary().estimate};
}

struct Estimates {
  double trials{};                   // mean of a run
  std::vector<double> threshold_db;  // of runs that have one
  std::vector<double> own_db;        // likewise; of a staircase where it settles
  double effort(const std::vector<double>& of) const {
    const double deviation = analysis::mean_and_spread(of).standard_deviation;
    return trials * deviation * deviation;
  }
};

Estimates estimates(const std::string& yaml, int runs) {
  const auto settings = testing::procedure_of(yaml);
  const analysis::PsychometricModel model{core::PsychometricShape::weibull, {0.5, 0.5}, {0.0, 0.1}};
  Estimates found;
  for (int run = 1; run <= runs; ++run) {
    const auto [levels, own_estimate] = answered(*settings, static_cast<std::uint64_t>(run));
    if (own_estimate) {
      found.own_db.push_back(20.0 * std::log10(*own_estimate / of_observer.threshold));
    }
    for (const analysis::Level& level : levels) {
      found.trials += static_cast<double>(level.answers.trials) / runs;
    }
    const auto fit = analysis::fit_psychometric(model, levels);
    if (const auto curve = analysis::curve_with_threshold(model, levels, fit)) {
      found.threshold_db.push_back(20.0 * std::log10(curve->threshold / of_observer.threshold));
    }
  }
  return found;
}
}  // namespace

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::atoi(argv[1]) : 200;
  fmt::print("{:<28} {:>6} {:>10} {:>9} {:>7} {:>24} {:>14}\n", "procedure", "trials", "thresholds",
             "bias [dB]", "SD [dB]", "trials for the same SD", "own estimate");
  double first = 0.0;
  double first_own = 0.0;
  for (const auto& [name, yaml] : procedures()) {
    const Estimates of = estimates(yaml, runs);
    const analysis::MeanAndSpread spread = analysis::mean_and_spread(of.threshold_db);
    const double effort = of.effort(of.threshold_db);
    first = first == 0.0 ? effort : first;
    first_own = first_own == 0.0 ? of.effort(of.own_db) : first_own;
    fmt::print("{:<28} {:>6.1f} {:>6}/{:<4} {:>8.2f} {:>7.2f} {:>22.2f} x {:>12}\n", name,
               of.trials, of.threshold_db.size(), runs, spread.mean, spread.standard_deviation,
               effort / first,
               of.own_db.empty() ? "–" : fmt::format("{:.2f} x", of.effort(of.own_db) / first_own));
  }
  return 0;
}
