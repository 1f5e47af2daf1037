// QUEST+ on observers whose psychometric function is known.
#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
#include "protocols/procedures/quest_plus_track.hpp"
#include "support/catch.hpp"
#include "support/known_observer.hpp"
#include "support/procedures.hpp"
using namespace tapstudy;

namespace {
constexpr int runs = 200;
const testing::KnownObserver::Parameters two_alternatives{core::PsychometricShape::gumbel, 0.13,
                                                          3.5, 0.5, 0.02};

std::string quest_plus_of(int trials, const std::string& stop = "") {
  return fmt::format(
      "quest_plus: {{function: gumbel, stimulus: {{min: -1.5, max: 1.5, count: 31}}, "
      "threshold: {{min: -1, max: 1, count: 41}}, slope: {{values: [2, 3.5, 5]}}, "
      "guess: {{values: [0.5]}}, lapse: {{values: [0.02]}}, stop: {{trials: {}{}}}}}",
      trials, stop);
}

struct Spread {
  double mean{};
  double deviation{};
  double trials{};
};
Spread estimates(const std::string& yaml) {
  const auto settings = testing::procedure_of(yaml);
  Spread all;
  double square = 0.0;
  for (std::uint64_t seed = 1; seed <= runs; ++seed) {
    testing::KnownObserver observer{two_alternatives, seed};
    const auto track = settings->start(seed);
    testing::run(*track, [&](const auto& values) { return observer.answer(values[0]); });
    const double estimate = track->summary().estimate.value();
    all.mean += estimate / runs;
    square += estimate * estimate / runs;
    all.trials += static_cast<double>(track->trials()) / runs;
  }
  all.deviation = std::sqrt((square - all.mean * all.mean) * runs / (runs - 1));
  return all;
}
}  // namespace

TEST_CASE("QUEST+ finds the threshold, with fewer trials than a staircase of the same spread",
          "[protocols][procedures]") {
  const Spread bayes = estimates(quest_plus_of(40));
  const Spread steps = estimates(
      "staircase: {rule: transformed, n_down: 2, steps: linear, start: 1, min: -1.5, max: 1.5, "
      "first_step: 0.4, min_step: 0.05, stop: {trials: 80}, estimate_reversals: 8}");
  CAPTURE(bayes.mean, bayes.deviation, steps.mean, steps.deviation, steps.trials);
  CHECK(bayes.mean ==
        Approx(two_alternatives.threshold).margin(4 * bayes.deviation / std::sqrt(runs)));
  CHECK(bayes.trials < 0.6 * steps.trials);
  CHECK(bayes.deviation < steps.deviation);
  const testing::KnownObserver known{two_alternatives, 1};
  CHECK(steps.mean == Approx(known.value_at(std::sqrt(0.5))).margin(0.05));
}

TEST_CASE("QUEST+ stops once the posterior is as narrow as asked", "[protocols][procedures]") {
  const auto settings = testing::procedure_of(quest_plus_of(200, ", threshold_sd: 0.08"));
  testing::KnownObserver observer{two_alternatives, 8};
  const auto track = settings->start(1);
  double before = 0.0;
  testing::run(*track, [&](const auto& values) {
    before = track->summary().parameters[0].standard_deviation;
    return observer.answer(values[0]);
  });
  CHECK(track->trials() < 200);
  CHECK(before > 0.08);
  CHECK(track->summary().parameters[0].standard_deviation <= 0.08);
}

TEST_CASE("the psi method is QUEST+ with guess and lapse rate fixed", "[protocols][procedures]") {
  const std::string common =
      "function: cumulative_gaussian, stimulus: {min: -2, max: 2, count: 17}, threshold: {min: -1, "
      "max: 1, count: 9}, slope: {values: [1, 2, 4], prior: normal, mean: 2, sd: 1}, stop: "
      "{trials: 30}";
  const auto psi =
      testing::procedure_of("psi: {guess: 0.25, lapse: 0.03, " + common + "}")->start(1);
  const auto general =
      testing::procedure_of("quest_plus: {guess: {values: [0.25]}, lapse: {values: [0.03]}, " +
                            common + "}")
          ->start(1);
  testing::KnownObserver observer{two_alternatives, 2};
  testing::run(*psi, [&](const std::vector<double>& values) {
    CHECK(general->next() == values);
    const std::size_t outcome = observer.answer(values[0]);
    general->observe(values, outcome);
    return outcome;
  });
  CHECK(psi->summary().estimate == general->summary().estimate);
}

TEST_CASE("QUEST+ learns from the value that was presented, on its grid or not",
          "[protocols][procedures]") {
  const auto track = testing::procedure_of(
                         "quest_plus: {function: logistic, stimulus: {values: [0, 1]}, threshold: "
                         "{values: [0, 1]}, slope: {values: [2]}, guess: {values: [0]}, lapse: "
                         "{values: [0]}, stop: {trials: 3}}")
                         ->start(1);
  track->observe({0.3}, 1);
  const testing::KnownObserver low{{core::PsychometricShape::logistic, 0.0, 2.0}, 1};
  const testing::KnownObserver high{{core::PsychometricShape::logistic, 1.0, 2.0}, 1};
  // Bayes' rule of two hypotheses, 0 and 1; the mean is the probability of the second
  CHECK(track->summary().estimate.value() ==
        Approx(high.probability(0.3) / (low.probability(0.3) + high.probability(0.3))));
}

TEST_CASE("an answer that no parameters allow is refused and changes nothing",
          "[protocols][procedures]") {
  const auto track = testing::procedure_of(
                         "quest_plus: {function: weibull, stimulus: {values: [1, 2]}, threshold: "
                         "{values: [1, 2]}, slope: {values: [5]}, guess: {values: [0.5]}, lapse: "
                         "{values: [0]}, stop: {trials: 3}}")
                         ->start(1);
  const auto before = track->next();
  CHECK_THROWS_WITH(track->observe({1000.0}, 0), Contains("impossible"));
  CHECK_THROWS_AS(track->observe({-1.0}, 0), core::InvalidInput);
  CHECK(track->trials() == 0);
  CHECK(track->next() == before);
}
