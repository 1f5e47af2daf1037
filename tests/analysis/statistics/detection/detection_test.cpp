// d' and criterion by hits and false alarms, against the R package psyphy and R's qnorm.
#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/statistics/detection/decision_model.hpp"
#include "analysis/statistics/detection/rates.hpp"
#include "analysis/statistics/distributions.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "support/catch.hpp"
#include "support/confusion_tables.hpp"
#include "support/reference_programs.hpp"
using namespace tapstudy;

TEST_CASE("d' of hits and false alarms is that of psyphy", "[analysis][detection]") {
  const std::vector<double> expected = testing::r_numbers(R"(
suppressMessages(library(psyphy))
exactly <- function(f) {
  environment(f) <- list2env(list(uniroot = function(...) stats::uniroot(..., tol = 1e-13)),
                             parent = environment(f))
  f
}
for (f in c(0.05, 0.2, 0.4)) for (h in c(0.5, 0.7, 0.95)) out(
  exactly(dprime.SD)(H = h, FA = f, method = 'diff'), dprime.SD(H = h, FA = f, method = 'IO'))
)");
  REQUIRE(expected.size() == 18);
  std::size_t next = 0;
  for (const double false_alarms : {0.05, 0.2, 0.4}) {
    for (const double hits : {0.5, 0.7, 0.95}) {
      INFO("hits " << hits << ", false alarms " << false_alarms);
      for (const auto by :
           {analysis::same_different_differencing, analysis::same_different_independent}) {
        CHECK(by(hits, false_alarms).d_prime == Approx(expected[next++]).epsilon(1e-9));
        CHECK(by(false_alarms, hits).d_prime == 0.0);
        CHECK(by(false_alarms, hits).is_below_chance);
      }
    }
  }
}

TEST_CASE("the hit rate of a differencing observer gives back d'", "[analysis][detection]") {
  CHECK(analysis::same_different_hit_rate(0.0, 0.3) == Approx(0.3).epsilon(1e-12));
  const double hits = analysis::same_different_hit_rate(1.7, 0.3);
  CHECK(analysis::same_different_differencing(hits, 0.3).d_prime == Approx(1.7).epsilon(1e-9));
}

TEST_CASE("yes/no d' and criterion are differences and means of z, with a half added to each count",
          "[analysis][detection]") {
  const std::vector<double> expected = testing::r_numbers(R"(
p <- (c(42, 13) + 0.5) / (c(50, 60) + 1); z <- qnorm(p)
se <- sqrt(sum(p * (1 - p) / (c(51, 61) * dnorm(z)^2)))
d <- z[1] - z[2]; c <- -mean(z); w <- qnorm(0.975) * se
out(d, d - w, d + w, c, c - w / 2, c + w / 2)
)");
  const auto result = analysis::yes_no_sensitivity({42, 50}, {13, 60});
  const std::array ours{
      result.d_prime,   result.d_prime_interval.low,   result.d_prime_interval.high,
      result.criterion, result.criterion_interval.low, result.criterion_interval.high};
  REQUIRE(expected.size() == ours.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    CHECK(ours[i] == Approx(expected[i]).epsilon(1e-10));
  }
  CHECK_FALSE(result.is_below_chance);
  CHECK(analysis::yes_no_sensitivity({2, 10}, {8, 10}).is_below_chance);
}

TEST_CASE("yes/no stays finite where every answer is right, and without bias c is 0",
          "[analysis][detection]") {
  const auto result = analysis::yes_no_sensitivity({20, 20}, {0, 20});
  CHECK(std::isfinite(result.d_prime));
  CHECK(result.d_prime > 3.0);
  CHECK(result.criterion == Approx(0.0).margin(1e-12));
  // "yes" to everything is a low criterion
  CHECK(analysis::yes_no_sensitivity({20, 20}, {18, 20}).criterion < -1.0);
}

TEST_CASE("rates and counts that are not possible are refused", "[analysis][detection]") {
  CHECK_THROWS_AS(analysis::log_linear_rate({3, 2}), core::InvalidInput);
  CHECK_THROWS_AS(analysis::log_linear_rate({-1, 2}), core::InvalidInput);
  CHECK_THROWS_AS(analysis::log_linear_rate({0, 0}), core::InvalidInput);
  CHECK_THROWS_AS(analysis::same_different_differencing(1.0, 0.2), core::InvalidInput);
  CHECK_THROWS_AS(analysis::same_different_independent(0.5, 0.0), core::InvalidInput);
  CHECK_THROWS_AS(analysis::same_different_hit_rate(-1.0, 0.2), core::InvalidInput);
}

TEST_CASE("intervals of same-different d' hold it in about 95 of 100 samples",
          "[analysis][detection]") {
  constexpr int samples = 2000;
  constexpr int trials = 60;
  constexpr double d_prime = 2.0;
  constexpr double differencing_false_alarms = 0.3;
  constexpr double hits = 0.76;
  constexpr double false_alarms = 0.24;
  const double independent_d_prime =
      analysis::same_different_independent(hits, false_alarms).d_prime;
  core::Rng rng{5};
  const auto drawn = [&](double rate) {
    analysis::Proportion of{0, trials};
    for (int i = 0; i < trials; ++i) {
      of.successes += rng.uniform() < rate ? 1 : 0;
    }
    return of;
  };
  int differencing = 0;
  int independent = 0;
  for (int i = 0; i < samples; ++i) {
    const auto range = analysis::same_different_differencing_interval(
        drawn(analysis::same_different_hit_rate(d_prime, differencing_false_alarms)),
        drawn(differencing_false_alarms));
    differencing += range && range->low <= d_prime && d_prime <= range->high ? 1 : 0;
    const auto other =
        analysis::same_different_independent_interval(drawn(hits), drawn(false_alarms));
    independent +=
        other && other->low <= independent_d_prime && independent_d_prime <= other->high ? 1 : 0;
  }
  CHECK(differencing == Approx(0.95 * samples).margin(0.025 * samples));
  CHECK(independent == Approx(0.95 * samples).margin(0.025 * samples));
  CHECK_FALSE(analysis::same_different_differencing_interval({3, 10}, {5, 10}));
  CHECK_FALSE(analysis::same_different_independent_interval({3, 10}, {5, 10}));
}

using namespace tapstudy::analysis;
using namespace tapstudy::testing;

TEST_CASE("one class is told from the rest by R's quantiles of corrected rates",
          "[analysis][detection]") {
  for (const CountTable& table : ordinary_tables()) {
    const auto r = r_numbers(
        "m <- " + r_matrix(table) +
        "; h <- (diag(m) + .5) / (rowSums(m) + 1); f <- (colSums(m) - diag(m) + .5) / "
        "(sum(m) - rowSums(m) + 1); out(qnorm(h) - qnorm(f), -(qnorm(h) + qnorm(f)) / 2)");
    const auto found = one_against_rest(table);
    for (std::size_t i = 0; i < table.size(); ++i) {
      REQUIRE(found[i]);
      CHECK(found[i]->d_prime == Approx(r[i]).epsilon(1e-9));
      CHECK(found[i]->criterion == Approx(r[table.size() + i]).margin(1e-12));
    }
  }
}

TEST_CASE("a class that was never presented, or alone, has no d'", "[analysis][detection]") {
  const auto found = one_against_rest(table_of_one_answer());
  CHECK_FALSE(found[0]);
  CHECK_FALSE(found[1]);
  CHECK(one_against_rest(table_with_a_class_never_answered())[1]->d_prime > -1.0);
  CHECK_THROWS_AS(one_against_rest({{1, 2, 3}, {4, 5, 6}}), core::InvalidInput);
}

TEST_CASE(
    "four alternatives' equivalent d' of the paper's 43 of 80 is R's integral's, and psyphy's",
    "[analysis][detection]") {
  const auto r = r_numbers(
      "p <- function(d) integrate(function(x) dnorm(x - d) * pnorm(x)^3, -Inf, Inf, rel.tol = "
      "1e-13, subdivisions = 1000)$value; out(uniroot(function(d) p(d) - 43 / 80, c(0, 5), "
      "tol = 1e-15)$root, psyphy::dprime.mAFC(43 / 80, 4))");
  const double d_prime = sensitivity({DecisionModel::forced_choice, 4}, {43, 80}).d_prime;
  CHECK(d_prime == Approx(r[0]).epsilon(1e-9));
  CHECK(d_prime == Approx(r[1]).epsilon(1e-6));  // psyphy searches to a tolerance of its own
}

// d' by decision models, against the R package psyphy, equations and simulated observers.
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
