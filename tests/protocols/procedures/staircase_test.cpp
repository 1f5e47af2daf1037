// Up-down staircases: where they settle, how they move.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "protocols/procedures/procedure.hpp"
#include "protocols/procedures/simulated_length.hpp"
#include "support/catch.hpp"
#include "support/procedures.hpp"
using namespace tapstudy;
using protocols::Track;

namespace {
const testing::KnownObserver::Parameters gradual{core::PsychometricShape::logistic, 0.0, 1.0, 0.0,
                                                 0.0};

std::string small_steps(const std::string& rule, double step = 0.1) {
  return fmt::format(
      "staircase: {{{}, steps: linear, start: 3, min: -20, max: 20, first_step: {}, "
      "stop: {{trials: 1000}}, estimate_reversals: 2}}",
      rule, step);
}

struct Settled {
  double mean_value{};
  double proportion_correct{};
};
// After the first 300 trials of each of 20 runs.
Settled settled(const std::string& yaml, const testing::KnownObserver::Parameters& parameters) {
  const auto settings = testing::procedure_of(yaml);
  Settled all;
  int counted = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    testing::KnownObserver observer{parameters, seed};
    const auto track = settings->start(seed);
    testing::run(*track, [&](const std::vector<double>& values) {
      const std::size_t outcome = observer.answer(values[0]);
      if (track->trials() >= 300) {
        all.mean_value += values[0];
        all.proportion_correct += static_cast<double>(outcome);
        ++counted;
      }
      return outcome;
    });
  }
  return {all.mean_value / counted, all.proportion_correct / counted};
}

// The values requested for these answers, the next one too.
std::vector<double> values_for(const std::string& yaml, const std::vector<std::size_t>& answers) {
  const auto track = testing::procedure_of(yaml)->start(1);
  std::vector<double> values{track->next().value()[0]};
  for (const std::size_t answer : answers) {
    track->observe({values.back()}, answer);
    values.push_back(track->next().value()[0]);
  }
  return values;
}
}  // namespace

TEST_CASE("a staircase of 1 up, n down settles where psi^n is one half",
          "[protocols][procedures]") {
  const testing::KnownObserver observer{gradual, 1};
  for (const int n : {1, 2, 3, 4}) {
    INFO(n << " down");
    const double levitt = std::pow(0.5, 1.0 / n);  // Levitt 1971, Table I
    const std::string yaml = small_steps(fmt::format("rule: transformed, n_down: {}", n));
    CHECK(testing::procedure_of(yaml)->start(1)->summary().target.value() ==
          Approx(levitt).epsilon(1e-12));
    CHECK(observer.probability(settled(yaml, gradual).mean_value) == Approx(levitt).margin(0.01));
  }
}

TEST_CASE("a staircase of n up, 1 down settles where (1 - psi)^n is one half",
          "[protocols][procedures]") {
  const testing::KnownObserver observer{gradual, 1};
  const double levitt = 1.0 - std::sqrt(0.5);
  const std::string yaml = small_steps("rule: transformed, n_down: 1, n_up: 2");
  CHECK(testing::procedure_of(yaml)->start(1)->summary().target.value() ==
        Approx(levitt).epsilon(1e-12));
  CHECK(observer.probability(settled(yaml, gradual).mean_value) == Approx(levitt).margin(0.01));
}

TEST_CASE("a weighted staircase settles at its target", "[protocols][procedures]") {
  const testing::KnownObserver observer{gradual, 1};
  for (const double target : {0.25, 0.5, 0.75, 0.9}) {
    INFO(target);
    const std::string yaml =
        small_steps(fmt::format("rule: weighted, target: {}", target), 0.1 * (1.0 - target));
    CHECK(testing::procedure_of(yaml)->start(1)->summary().target.value() ==
          Approx(target).epsilon(1e-12));
    const Settled end = settled(yaml, gradual);
    CHECK(observer.probability(end.mean_value) == Approx(target).margin(0.01));
    // steps cancel over a run: Kaernbach's equation, whatever the psychometric function
    CHECK(end.proportion_correct == Approx(target).margin(0.005));
  }
}

TEST_CASE("the estimate of a staircase is where it settles", "[protocols][procedures]") {
  const auto settings = testing::procedure_of(
      "staircase: {rule: transformed, n_down: 2, steps: linear, start: 5, min: -20, max: 20, "
      "first_step: 2, min_step: 0.25, stop: {reversals: 30}, estimate_reversals: 20}");
  const testing::KnownObserver known{gradual, 1};
  double mean = 0.0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    testing::KnownObserver observer{gradual, seed};
    const auto track = settings->start(seed);
    testing::run(*track, [&](const auto& values) { return observer.answer(values[0]); });
    const auto summary = track->summary();
    REQUIRE(summary.reversals.size() == 30);
    mean += summary.estimate.value() / 400.0;
  }
  CHECK(known.probability(mean) == Approx(std::sqrt(0.5)).margin(0.015));
}

TEST_CASE("a staircase brackets the border of an observer without noise",
          "[protocols][procedures]") {
  for (const bool is_harder_above : {false, true}) {
    const auto track =
        testing::procedure_of(
            fmt::format("staircase: {{rule: transformed, n_down: 1, steps: linear, start: {}, "
                        "min: 0, max: 10, first_step: 2, min_step: 0.125, stop: {{trials: 60}}, "
                        "estimate_reversals: 6, after_correct: {}}}",
                        is_harder_above ? 0.5 : 9.5, is_harder_above ? "increase" : "decrease"))
            ->start(1);
    std::vector<double> seen;
    testing::run(*track, [&](const std::vector<double>& values) -> std::size_t {
      seen.push_back(values[0]);
      return (values[0] > 3.3) == is_harder_above ? 0 : 1;
    });
    for (std::size_t i = 30; i < seen.size(); ++i) {
      CHECK(std::abs(seen[i] - 3.3) <= 0.125);
    }
    CHECK(track->summary().estimate.value() == Approx(3.3).margin(0.0625));
  }
}

TEST_CASE("reversals are the peaks and valleys of the values", "[protocols][procedures]") {
  const auto track = testing::procedure_of(small_steps("rule: transformed, n_down: 2"))->start(1);
  testing::KnownObserver observer{gradual, 5};
  std::vector<double> seen;
  testing::run(*track, [&](const std::vector<double>& values) {
    seen.push_back(values[0]);
    return observer.answer(values[0]);
  });
  std::vector<double> turns;  // of the values without their repetitions
  std::vector<double> distinct = seen;
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  for (std::size_t i = 1; i + 1 < distinct.size(); ++i) {
    if ((distinct[i] > distinct[i - 1]) != (distinct[i + 1] > distinct[i])) {
      turns.push_back(distinct[i]);
    }
  }
  const auto summary = track->summary();
  REQUIRE(summary.reversals.size() >= turns.size());
  REQUIRE(summary.reversals.size() <= turns.size() + 1);  // the last answer may have been one
  for (std::size_t i = 0; i < turns.size(); ++i) {
    CHECK(summary.reversals[i].value == turns[i]);
    CHECK(seen[summary.reversals[i].trial - 1] == turns[i]);
  }
  REQUIRE(summary.reversals.size() >= 2);
  CHECK(summary.estimate.value() ==
        Approx((summary.reversals.rbegin()[0].value + summary.reversals.rbegin()[1].value) / 2));
}

TEST_CASE("steps halve at reversals down to the least, in value, decibels or factors",
          "[protocols][procedures]") {
  // correct, wrong, correct, wrong, wrong: three reversals, then a step on
  const std::vector<std::size_t> answers{1, 0, 1, 0, 0};
  const auto yaml = [](const std::string& steps) {
    return "staircase: {rule: transformed, n_down: 1, start: 10, min: 1, max: 100, " + steps +
           ", stop: {trials: 50}, estimate_reversals: 2}";
  };
  const std::vector<double> steps{-4, 2, -1, 1, 1};
  const auto linear = values_for(yaml("steps: linear, first_step: 4, min_step: 1"), answers);
  const auto db = values_for(yaml("steps: db, first_step: 4, min_step: 1"), answers);
  const auto factor =
      values_for(yaml(fmt::format("steps: factor, first_step: {:.17g}, min_step: {:.17g}",
                                  std::pow(10.0, 0.2), std::pow(10.0, 0.05))),
                 answers);
  CHECK(linear[0] == 10.0);
  CHECK(db[0] == 10.0);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    CHECK(linear[i + 1] - linear[i] == Approx(steps[i]).epsilon(1e-12));
    CHECK(20.0 * std::log10(db[i + 1] / db[i]) == Approx(steps[i]).epsilon(1e-12));
    CHECK(factor[i + 1] == Approx(db[i + 1]).epsilon(1e-12));
  }
}

TEST_CASE("the estimate of a staircase in decibels is a geometric mean",
          "[protocols][procedures]") {
  const auto track = testing::procedure_of(
                         "staircase: {rule: transformed, n_down: 1, start: 10, min: 1, max: 100, "
                         "steps: db, first_step: 6, stop: {reversals: 2}, estimate_reversals: 2}")
                         ->start(1);
  testing::run(*track, [&](const auto& /*values*/) { return track->trials() == 1 ? 0U : 1U; });
  const auto summary = track->summary();
  REQUIRE(summary.reversals.size() == 2);
  CHECK(summary.estimate.value() ==
        Approx(std::sqrt(summary.reversals[0].value * summary.reversals[1].value)));
}

TEST_CASE("a staircase stops at its limits and comes back", "[protocols][procedures]") {
  const std::string yaml =
      "staircase: {rule: transformed, n_down: 1, start: 5, min: 1, max: 6, steps: linear, "
      "first_step: 3, stop: {trials: 20}, estimate_reversals: 2}";
  CHECK(values_for(yaml, {1, 1, 1, 0}) == std::vector<double>{5, 2, 1, 1, 4});
  CHECK(values_for(yaml, {0, 0}) == std::vector<double>{5, 6, 6});
  const auto track = testing::procedure_of(yaml)->start(1);
  for (int i = 0; i < 4; ++i) {
    track->observe({5}, 1);
  }
  CHECK(track->summary().trials_at_limit == 2);
}

TEST_CASE("a staircase steps from what it requested, not from what could be built",
          "[protocols][procedures]") {
  const std::string yaml = small_steps("rule: transformed, n_down: 1");
  const auto exact = testing::procedure_of(yaml)->start(1);
  const auto rounded = testing::procedure_of(yaml)->start(1);
  for (const std::size_t answer : {1U, 1U, 1U, 0U, 1U}) {
    const double value = exact->next().value()[0];
    exact->observe({value}, answer);
    rounded->observe({std::round(value)}, answer);
    CHECK(rounded->next() == exact->next());
  }
}

namespace {
std::string until(int reversals) {
  return fmt::format(
      "staircase: {{rule: transformed, n_down: 2, steps: db, start: 1, min: 0.01, max: 1, "
      "first_step: 4, min_step: 1, stop: {{reversals: {}, trials: 1000}}, estimate_reversals: 2}}",
      reversals);
}
}  // namespace

TEST_CASE("the usual length of a staircase is the median over people with thresholds at any level",
          "[protocols][procedures][check]") {
  const auto settings = testing::procedure_of(until(8));
  std::vector<double> trials;
  for (std::uint64_t person = 0; person < 400; ++person) {
    // the unit is one of log10, of which there are two from limit to limit
    const double threshold = -2.0 + 2.0 * (static_cast<double>(person) + 0.5) / 400.0;
    testing::KnownObserver observer{
        {core::PsychometricShape::cumulative_gaussian, threshold, 4.0, 0.5, 0.02}, 1000 + person};
    const auto track = settings->start(person);
    testing::run(*track, [&](const std::vector<double>& values) {
      return observer.answer(std::log10(values[0]));
    });
    trials.push_back(static_cast<double>(track->trials()));
  }
  std::ranges::sort(trials);
  const protocols::TrackLength length = protocols::simulated_length(*settings, 0.5);
  CHECK(static_cast<double>(length.usual) == Approx(trials[200]).epsilon(0.2));
  CHECK(static_cast<double>(length.most) == Approx(trials[380]).epsilon(0.25));
}

TEST_CASE("reversals make a staircase long, its limit of trials makes it end",
          "[protocols][procedures][check]") {
  const auto length = [](const std::string& yaml) {
    return protocols::simulated_length(*testing::procedure_of(yaml), 0.5);
  };
  const auto once = static_cast<double>(length(until(10)).usual);
  CHECK(static_cast<double>(length(until(40)).usual) == Approx(4.0 * once).epsilon(0.25));
  const auto whole = length(small_steps("rule: transformed, n_down: 2"));
  CHECK(whole.usual == 1000);
  CHECK(whole.most == 1000);
}
