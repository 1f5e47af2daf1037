#include "analysis/statistics/proportion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>

#include "analysis/report/document/wording.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/resampling/null_tables.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "support/catch.hpp"
#include "support/reference_programs.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using testing::r_numbers;

namespace {
// Sums the outcomes no more probable than the one observed.
const std::string r_multinomial =
    "f <- function(...) { o <- c(...); n <- sum(o); k <- length(o); e <- rep(1 / k, k);"
    "g <- as.matrix(expand.grid(rep(list(0:n), k - 1))); g <- g[rowSums(g) <= n, , drop = FALSE];"
    "p <- apply(cbind(g, n - rowSums(g)), 1, dmultinom, prob = e);"
    "sum(p[p <= dmultinom(o, prob = e) * (1 + 1e-9)]) };";

// of_r: a test of o[1] successes in o[2] trials that has a conf.int.
void check_intervals(Interval (*interval_of)(const Proportion&), const std::string& of_r) {
  const std::vector<Proportion> proportions{{5, 8}, {0, 10}, {10, 10}, {43, 80}, {1, 1}};
  const auto r =
      r_numbers("for (o in list(c(5, 8), c(0, 10), c(10, 10), c(43, 80), c(1, 1))) out(" + of_r +
                "$conf.int)");
  REQUIRE(r.size() == 2 * proportions.size());
  for (std::size_t i = 0; i < proportions.size(); ++i) {
    CAPTURE(proportions[i].successes, proportions[i].trials);
    const Interval interval = interval_of(proportions[i]);
    CHECK(interval.low == Approx(r[2 * i]).epsilon(1e-9).margin(1e-15));
    CHECK(interval.high == Approx(r[2 * i + 1]).epsilon(1e-9));
  }
}
}  // namespace

TEST_CASE("the Wilson interval is that of R's prop.test without a correction", "[analysis]") {
  check_intervals(wilson_interval, "suppressWarnings(prop.test(o[1], o[2], correct = FALSE))");
}

TEST_CASE("the Wilson interval solves its own equation", "[analysis]") {
  // (p - p0)² = z² p0 (1 - p0) / n at both ends
  const Proportion observed{43, 80};
  const Interval interval = wilson_interval(observed);
  for (const double end : {interval.low, interval.high}) {
    const double z2 = std::pow(observed.value() - end, 2) * 80.0 / (end * (1.0 - end));
    CHECK(std::sqrt(z2) == Approx(1.959963984540054).epsilon(1e-9));
  }
}

TEST_CASE("the exact interval is that of R's binom.test", "[analysis]") {
  check_intervals(exact_interval, "binom.test(o[1], o[2])");
}

TEST_CASE("so many right answers are needed against chance, as by R's binom.test", "[analysis]") {
  const auto r = r_numbers(
      "t <- function(k, n, p) binom.test(k, n, p, 'greater')$p.value;"
      "out(t(5, 8, .25), t(27, 80, .25), t(7, 10, 1 / 3), t(43, 80, .25))");
  CHECK(binomial_p_at_least({5, 8}, 0.25) == Approx(r[0]).epsilon(1e-9));
  CHECK(binomial_p_at_least({27, 80}, 0.25) == Approx(r[1]).epsilon(1e-9));
  CHECK(binomial_p_at_least({7, 10}, 1.0 / 3.0) == Approx(r[2]).epsilon(1e-9));
  CHECK(binomial_p_at_least({43, 80}, 0.25) == Approx(r[3]).epsilon(1e-9));
  CHECK(critical_successes(8, 0.25, 0.05) == 5);
  CHECK(critical_successes(80, 0.25, 0.05) == 27);
  CHECK(binomial_p_at_least({0, 10}, 0.25) == 1.0);
  CHECK(critical_successes(1, 0.25, 0.05) == 2);
  CHECK(binomial_power(1, 0.25, 0.05, 0.9) == 0.0);
}

TEST_CASE("the exact multinomial test orders outcomes by probability", "[analysis]") {
  const std::vector<std::vector<int>> outcomes{{8, 1, 1}, {7, 3, 0},  {7, 2, 1},
                                               {6, 4, 0}, {12, 5, 3}, {1, 1, 1}};
  std::string script = r_multinomial;
  for (const std::vector<int>& counts : outcomes) {
    script += fmt::format("out(f({}));", fmt::join(counts, ","));
  }
  const auto r = r_numbers(script);
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    CHECK(exact_multinomial_p(outcomes[i]).value() == Approx(r[i]).epsilon(1e-9));
  }
  CHECK(exact_multinomial_p({4, 0, 0}).value() == Approx(3.0 / 81.0).epsilon(1e-12));  // all alike
  CHECK_FALSE(exact_multinomial_p({400, 0, 0, 0, 0, 0, 0, 0}).has_value());  // too many outcomes
}

TEST_CASE("p values are said as they are printed in papers", "[analysis][report]") {
  CHECK(p_value(0.0201) == "p = .020");
  CHECK(p_value(0.00001) == "p < .001");
  CHECK(p_value(1.0) == "p = 1.000");
  CHECK(p_value(0.99996) == "p = 1.000");
}

TEST_CASE("simultaneous intervals of choices are Goodman's, as statsmodels has them",
          "[analysis][choice]") {
  const std::vector<std::vector<int>> choices{{7, 2, 1}, {10, 0, 0}, {1, 0}, {30, 40, 50, 3}};
  std::string script =
      "from statsmodels.stats.proportion import multinomial_proportions_confint as ci\n";
  for (const auto& counts : choices) {
    script += fmt::format("out(ci(np.array({}), method='goodman'))\n", counts);
  }
  const auto expected = testing::python_numbers(script);
  std::size_t at = 0;
  for (const auto& counts : choices) {
    for (const Interval& interval : simultaneous_intervals(counts)) {
      CHECK(interval.low == Approx(expected[at]).margin(1e-12));
      CHECK(interval.high == Approx(expected[at + 1]).epsilon(1e-9));
      at += 2;
    }
  }
  CHECK_THROWS_AS(simultaneous_intervals({5}), core::InvalidInput);
  CHECK_THROWS_AS(simultaneous_intervals({0, 0}), core::InvalidInput);
  CHECK_THROWS_AS(simultaneous_intervals({3, -1}), core::InvalidInput);
}

// Newcombe 1998 (Statistics in Medicine 17, 873-890), Table II, method 10: 56/70 less 48/80, of the
// score intervals that R's prop.test gives.
TEST_CASE("differences of proportions have Newcombe's interval", "[analysis][proportion]") {
  const auto r = testing::r_numbers(
      "a <- prop.test(48, 80, correct = FALSE)$conf.int; b <- prop.test(56, 70, correct = FALSE)"
      "$conf.int; p <- 48 / 80; q <- 56 / 70; out(a, b, q - p - sqrt((q - b[1])^2 + "
      "(a[2] - p)^2), q - p + sqrt((b[2] - q)^2 + (p - a[1])^2))");
  const auto estimate = [](const Proportion& proportion) {
    return IntervalEstimate{proportion.value(), wilson_interval(proportion)};
  };
  const IntervalEstimate difference =
      independent_difference(estimate({48, 80}), estimate({56, 70}));
  CHECK(difference.value == Approx(0.2).epsilon(1e-9));
  CHECK(difference.interval.low == Approx(0.0524).margin(0.00005));  // as printed
  CHECK(difference.interval.high == Approx(0.3339).margin(0.00005));
  CHECK(wilson_interval({48, 80}).low == Approx(r[0]).epsilon(1e-9));
  CHECK(wilson_interval({48, 80}).high == Approx(r[1]).epsilon(1e-9));
  CHECK(wilson_interval({56, 70}).low == Approx(r[2]).epsilon(1e-9));
  CHECK(wilson_interval({56, 70}).high == Approx(r[3]).epsilon(1e-9));
  CHECK(difference.interval.low == Approx(r[4]).epsilon(1e-9));
  CHECK(difference.interval.high == Approx(r[5]).epsilon(1e-9));
}

TEST_CASE("the difference of means whose intervals are by t has Welch's interval, as R's t.test",
          "[analysis][proportion]") {
  const std::vector<double> x{1.0, 2.5, 4.0};
  const std::vector<double> y{3.0, 9.0, 4.5, 7.0, 6.0};
  const auto estimate = [](const std::vector<double>& values) {
    const Interval range = t_interval(values);
    return IntervalEstimate{0.5 * (range.low + range.high), range,
                            static_cast<double>(values.size()) - 1.0};
  };
  const auto ours = independent_difference(estimate(x), estimate(y));
  const auto r = testing::r_numbers("t <- t.test(" + testing::r_vector(y) + ", " +
                                    testing::r_vector(x) + "); out(t$conf.int)");
  CHECK(ours.interval.low == Approx(r[0]).epsilon(1e-9));
  CHECK(ours.interval.high == Approx(r[1]).epsilon(1e-9));
  // of an estimate without a limit there is none
  const double infinite = std::numeric_limits<double>::infinity();
  CHECK(independent_difference(estimate(x), {1.0, {0.0, infinite}, 2.0}).interval.high == infinite);
}

TEST_CASE("a difference the other way round is its negative", "[analysis][proportion]") {
  const IntervalEstimate a{1.0, {0.2, 1.3}};
  const IntervalEstimate b{4.0, {3.1, 6.0}};
  const IntervalEstimate forth = independent_difference(a, b);
  const IntervalEstimate back = independent_difference(b, a);
  CHECK(forth.value == -back.value);
  CHECK(forth.interval.low == Approx(-back.interval.high).epsilon(1e-9));
  CHECK(forth.interval.high == Approx(-back.interval.low).epsilon(1e-9));
}

TEST_CASE("a ratio and its interval are the other way round the reciprocals",
          "[analysis][statistics]") {
  const IntervalEstimate a{0.2, {0.1, 0.5}};
  const IntervalEstimate b{0.6, {0.5, 0.9}};
  const IntervalEstimate forth = independent_ratio(a, b);
  const IntervalEstimate back = independent_ratio(b, a);
  CHECK(forth.value == Approx(3.0));
  CHECK(back.value == Approx(1.0 / 3.0));
  CHECK(back.interval.low == Approx(1.0 / forth.interval.high));
  CHECK(back.interval.high == Approx(1.0 / forth.interval.low));
}
