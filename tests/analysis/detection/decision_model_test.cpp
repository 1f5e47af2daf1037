// d' by decision models, against the R package psyphy, equations and simulated observers.
#include "analysis/detection/decision_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/statistics/distributions.hpp"
#include "core/error.hpp"
#include "core/rng.hpp"
#include "support/catch.hpp"
#include "support/r_program.hpp"
using namespace tapstudy;
using analysis::DecisionModel;
using analysis::DecisionTask;
using testing::r_numbers;

namespace {
// Every model with a number of alternatives that it has.
const std::array tasks{DecisionTask{DecisionModel::forced_choice, 2},
                       DecisionTask{DecisionModel::forced_choice, 7},
                       DecisionTask{DecisionModel::oddity, 3},
                       DecisionTask{DecisionModel::oddity, 4},
                       DecisionTask{DecisionModel::abx_differencing, 2},
                       DecisionTask{DecisionModel::abx_independent_observation, 2},
                       DecisionTask{DecisionModel::same_different_independent_observation, 2}};

// The proportion right of an observer who takes that of m, the first shifted, furthest from their
// mean.
double simulated_oddity(double d_prime, int alternatives, int trials) {
  core::Rng rng{77};
  int right = 0;
  std::vector<double> x(static_cast<std::size_t>(alternatives));
  for (int trial = 0; trial < trials; ++trial) {
    double mean = 0.0;
    for (double& one : x) {
      one = rng.normal() + (&one == x.data() ? d_prime : 0.0);
      mean += one / alternatives;
    }
    const auto chosen =
        std::ranges::max_element(x, {}, [&](double one) { return std::abs(one - mean); });
    right += chosen == x.begin() ? 1 : 0;
  }
  return static_cast<double>(right) / trials;
}
}  // namespace

TEST_CASE("d' of proportions correct is that of psyphy, as far as its integrals go",
          "[analysis][detection]") {
  // psyphy finds roots, and integrates, to 1.2e-4 unless told otherwise
  const std::vector<double> expected = r_numbers(R"(
suppressMessages(library(psyphy))
exactly <- function(f) {
  environment(f) <- list2env(list(uniroot = function(...) stats::uniroot(..., tol = 1e-15),
                                  integrate = function(...) stats::integrate(..., rel.tol = 1e-12, subdivisions = 2000)),
                             parent = environment(f))
  f
}
for (m in c(2, 3, 4, 8)) for (p in seq(1 / m + 0.02, 0.99, length.out = 9))
  out(exactly(dprime.mAFC)(p, m))
for (p in seq(0.35, 0.99, length.out = 9)) out(exactly(dprime.oddity)(p))
for (p in seq(0.52, 0.99, length.out = 9)) out(exactly(dprime.ABX)(Pc.unb = p, method = 'diff'))
for (p in seq(0.52, 0.99, length.out = 9)) out(exactly(dprime.ABX)(Pc.unb = p, method = 'IO'))
for (p in seq(0.52, 0.99, length.out = 9)) out(dprime.SD(zdiff = 2 * qnorm(p), method = 'IO'))
)");
  REQUIRE(expected.size() == 9 * 8);
  std::size_t next = 0;
  const auto compare = [&](const DecisionTask& task, double low) {
    for (int i = 0; i < 9; ++i) {
      const double proportion = low + (0.99 - low) * i / 8.0;
      INFO("model " << static_cast<int>(task.model) << " at " << proportion);
      CHECK(analysis::d_prime_of(task, proportion) == Approx(expected[next++]).epsilon(1e-9));
    }
  };
  for (const int m : {2, 3, 4, 8}) {
    compare({DecisionModel::forced_choice, m}, 1.0 / m + 0.02);
  }
  compare({DecisionModel::oddity, 3}, 0.35);
  compare({DecisionModel::abx_differencing, 2}, 0.52);
  compare({DecisionModel::abx_independent_observation, 2}, 0.52);
  compare({DecisionModel::same_different_independent_observation, 2}, 0.52);
}

TEST_CASE("with no sensitivity a proportion is chance, and d' is the inverse of the proportion",
          "[analysis][detection]") {
  for (const DecisionTask& task : tasks) {
    INFO("model " << static_cast<int>(task.model) << " of " << task.alternatives);
    CHECK(analysis::proportion_correct(task, 0.0) == Approx(1.0 / task.alternatives).epsilon(1e-9));
    double before = 0.0;
    for (const double d_prime : {0.05, 0.4, 1.0, 2.3, 4.0}) {
      const double proportion = analysis::proportion_correct(task, d_prime);
      CHECK(proportion > before);
      CHECK(analysis::d_prime_of(task, proportion) == Approx(d_prime).epsilon(1e-9));
      before = proportion;
    }
  }
}

TEST_CASE("forced choice of two is a Gaussian of d' over root 2", "[analysis][detection]") {
  for (const double d_prime : {0.0, 0.3, 1.0, 2.5}) {
    CHECK(analysis::proportion_correct({DecisionModel::forced_choice, 2}, d_prime) ==
          Approx(analysis::normal_cdf(d_prime / std::sqrt(2.0))).epsilon(1e-10));
  }
}

TEST_CASE("odd ones are found as often as simulated observers find them", "[analysis][detection]") {
  constexpr int trials = 200'000;  // standard error below 0.0012
  for (const int alternatives : {3, 4}) {
    for (const double d_prime : {0.8, 2.0}) {
      INFO(alternatives << " at " << d_prime);
      CHECK(analysis::proportion_correct({DecisionModel::oddity, alternatives}, d_prime) ==
            Approx(simulated_oddity(d_prime, alternatives, trials)).margin(0.005));
    }
  }
}

TEST_CASE("an interval of d' is that of the proportion, and below chance d' is 0",
          "[analysis][detection]") {
  const DecisionTask task{DecisionModel::forced_choice, 2};
  const auto good = analysis::sensitivity(task, {40, 50});
  const auto score = analysis::wilson_interval({40, 50});
  CHECK(good.d_prime == Approx(std::sqrt(2.0) * analysis::normal_quantile(0.8)).epsilon(1e-9));
  CHECK(good.interval.low ==
        Approx(std::sqrt(2.0) * analysis::normal_quantile(score.low)).epsilon(1e-9));
  CHECK(good.interval.high ==
        Approx(std::sqrt(2.0) * analysis::normal_quantile(score.high)).epsilon(1e-9));
  CHECK_FALSE(good.is_below_chance);

  const auto worse = analysis::sensitivity(task, {20, 50});
  CHECK(worse.d_prime == 0.0);
  CHECK(worse.interval.low == 0.0);
  CHECK(worse.interval.high > 0.0);  // chance is not excluded
  CHECK(worse.is_below_chance);

  const auto perfect = analysis::sensitivity(task, {50, 50});
  CHECK(perfect.is_perfect);
  CHECK(perfect.d_prime == Approx(std::sqrt(2.0) * analysis::normal_quantile(0.99)).epsilon(1e-9));
  CHECK(std::isinf(perfect.interval.high));
}

TEST_CASE("decision models are known by name and refuse what they are not defined for",
          "[analysis][detection]") {
  for (const auto& row : analysis::decision_models()) {
    CHECK(analysis::find_decision_model(row.name) == &row);
    CHECK(&row - analysis::decision_models().data() == static_cast<int>(row.model));
  }
  CHECK(analysis::find_decision_model("guess") == nullptr);
  CHECK_THROWS_AS(analysis::chance({DecisionModel::oddity, 5}), core::InvalidInput);
  CHECK_THROWS_AS(analysis::chance({DecisionModel::forced_choice, 1}), core::InvalidInput);
  CHECK_THROWS_AS(analysis::chance({DecisionModel::abx_differencing, 3}), core::InvalidInput);
  const DecisionTask task{DecisionModel::forced_choice, 2};
  CHECK_THROWS_AS(analysis::proportion_correct(task, -0.1), core::InvalidInput);
  CHECK_THROWS_AS(analysis::d_prime_of(task, 1.1), core::InvalidInput);
  CHECK_THROWS_AS(analysis::sensitivity(task, {6, 5}), core::InvalidInput);
  CHECK_THROWS_AS(analysis::sensitivity(task, {0, 0}), core::InvalidInput);
}
