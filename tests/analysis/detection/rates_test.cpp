// d' and criterion by hits and false alarms, against the R package psyphy and R's qnorm.
#include "analysis/detection/rates.hpp"

#include <array>
#include <cmath>

#include "analysis/detection/decision_model.hpp"
#include "core/error.hpp"
#include "core/rng.hpp"
#include "support/catch.hpp"
#include "support/r_program.hpp"
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
