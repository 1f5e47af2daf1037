#include "analysis/statistics/population/test_retest.hpp"

#include <cmath>

#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "support/catch.hpp"
#include "support/reference_programs.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using namespace tapstudy::testing;

namespace {
using Values = std::vector<double>;
using Occasions = std::vector<Values>;

// Value and interval of ICC(A,1), as psych has them.
Values correlation_by_psych(const Occasions& occasions) {
  std::string columns;
  for (const Values& values : occasions) {
    columns += (columns.empty() ? "" : ", ") + r_vector(values);
  }
  return r_numbers("suppressPackageStartupMessages(library(psych)); out(unlist(ICC(cbind(" +
                   columns + "), lmer = FALSE)$results[2, c(2, 7, 8)]))");
}

// People of variance 1 whose single measurements add error, and a shift of the second occasion.
Occasions study(std::uint64_t number, int people, double error, double shift) {
  core::Rng rng{core::derived_seed(21, core::Purpose::study, number)};
  Occasions occasions(2);
  for (int i = 0; i < people; ++i) {
    const double person = rng.normal();
    occasions[0].push_back(person + error * rng.normal());
    occasions[1].push_back(person + error * rng.normal() + shift);
  }
  return occasions;
}

bool holds(const Interval& interval, double value) {
  return interval.low <= value && value <= interval.high;
}
}  // namespace

TEST_CASE("the intra-class correlation and its interval are psych's", "[analysis][retest]") {
  const std::vector<Occasions> cases{
      {{9, 6, 8, 7, 10, 6}, {2, 1, 4, 1, 5, 2}, {5, 3, 6, 2, 6, 4}, {8, 2, 8, 6, 9, 7}},
      {{0.5, 0.7, 0.6, 0.9, 0.75}, {0.55, 0.8, 0.6, 0.85, 0.9}},
      {{1.0, 2.0, 3.0}, {3.0, 1.0, 2.0}},
      study(1, 40, 0.5, 0.3)};
  for (const Occasions& occasions : cases) {
    const Values expected = correlation_by_psych(occasions);
    const auto found = intraclass_correlation(occasions);
    REQUIRE(found);
    CHECK(found->value == Approx(expected[0]).epsilon(1e-9));
    CHECK(found->interval.low == Approx(expected[1]).epsilon(1e-9));
    CHECK(found->interval.high == Approx(expected[2]).epsilon(1e-9));
  }
  // Shrout & Fleiss 1979, four judges of six targets: .29
  CHECK(intraclass_correlation(cases[0])->value == Approx(0.29).margin(0.005));
}

TEST_CASE("limits of agreement have the intervals of R's non-central t", "[analysis][retest]") {
  for (const int people : {2, 3, 8, 100}) {
    const Occasions values = study(2, people, 0.4, -0.2);
    const auto expected = r_numbers(
        "d <- " + r_vector(values[1]) + " - " + r_vector(values[0]) +
        "; n <- length(d); z <- qnorm(.975); k <- qt(c(.025, .975), n - 1, z * sqrt(n)) / sqrt(n);"
        "out(mean(d), t.test(d)$conf.int, mean(d) + c(-z, z) * sd(d), mean(d) - rev(k) * sd(d),"
        "mean(d) + k * sd(d))");
    const LimitsOfAgreement found = limits_of_agreement(values[0], values[1]);
    REQUIRE(found.mean_interval);
    const Values all{found.mean,
                     found.mean_interval->low,
                     found.mean_interval->high,
                     found.limits.low,
                     found.limits.high,
                     found.low_interval->low,
                     found.low_interval->high,
                     found.high_interval->low,
                     found.high_interval->high};
    for (std::size_t i = 0; i < all.size(); ++i) {
      INFO(people << " people, number " << i);
      CHECK(all[i] == Approx(expected[i]).epsilon(1e-6));
    }
  }
}

TEST_CASE("of very many people, the intervals of limits close around them", "[analysis][retest]") {
  const Occasions values = study(3, 20'000, 0.4, 0.0);
  const Interval high = *limits_of_agreement(values[0], values[1]).high_interval;
  const double limit = 1.959964 * 0.4 * std::sqrt(2.0);
  CHECK(high.low == Approx(limit).epsilon(0.05));
  CHECK(high.high == Approx(limit).epsilon(0.05));
}

TEST_CASE("intervals of limits and correlation hold what was planted in 95 % of studies",
          "[analysis][retest]") {
  constexpr int studies = 1000;
  constexpr double error = 0.6;
  const double limit = 1.959964 * error * std::sqrt(2.0);
  const double correlation = 1.0 / (1.0 + error * error);
  for (const int people : {3, 5, 12}) {
    int limits_held = 0;
    int correlation_held = 0;
    for (int number = 0; number < studies; ++number) {
      const Occasions values = study(static_cast<std::uint64_t>(number), people, error, 0.0);
      limits_held += holds(*limits_of_agreement(values[0], values[1]).high_interval, limit) ? 1 : 0;
      correlation_held += holds(intraclass_correlation(values)->interval, correlation) ? 1 : 0;
    }
    INFO(people << " people");
    const double scatter = 4.0 * std::sqrt(studies * 0.05 * 0.95);
    CHECK(std::abs(limits_held - 950) <= scatter);
    CHECK(std::abs(correlation_held - 950) <= scatter);
  }
}

TEST_CASE("a common change lowers the correlation, and moves the limits without widening them",
          "[analysis][retest]") {
  const Occasions still = study(5, 20, 0.3, 0.0);
  const Occasions moved = study(5, 20, 0.3, 2.0);
  CHECK(intraclass_correlation(moved)->value < 0.5 * intraclass_correlation(still)->value);
  const LimitsOfAgreement one = limits_of_agreement(still[0], still[1]);
  const LimitsOfAgreement other = limits_of_agreement(moved[0], moved[1]);
  CHECK(other.mean - one.mean == Approx(2.0));
  CHECK(other.limits.high - other.limits.low == Approx(one.limits.high - one.limits.low));
}

TEST_CASE("what two people did not measure twice has no agreement", "[analysis][retest]") {
  CHECK_THROWS_AS(limits_of_agreement({1.0}, {2.0}), core::InvalidInput);
  CHECK_THROWS_AS(limits_of_agreement({1.0, 2.0}, {2.0, 3.0, 4.0}), core::InvalidInput);
  CHECK_THROWS_AS(intraclass_correlation({{1.0, 2.0}}), core::InvalidInput);
  CHECK_THROWS_AS(intraclass_correlation({{1.0, 2.0}, {1.0, std::nan("")}}), core::InvalidInput);
  CHECK_FALSE(limits_of_agreement({1.0, 2.0}, {2.0, 3.0}).low_interval);
  CHECK_FALSE(intraclass_correlation({{1.0, 2.0}, {2.0, 3.0}}));
  CHECK_FALSE(intraclass_correlation({{0.1, 0.1, 0.1}, {0.1, 0.1, 0.1}}));
  CHECK_FALSE(intraclass_correlation({{1.0, 2.0}, {2.0, 1.0}}));  // means do not differ
  CHECK_FALSE(do_people_differ({{0.1, 0.3}, {0.3, 0.1}}));
  CHECK(do_people_differ({{1.0, 2.0}, {2.0, 3.0}}));
}
