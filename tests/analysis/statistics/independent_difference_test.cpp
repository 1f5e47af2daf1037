#include "analysis/statistics/independent_difference.hpp"

#include "support/r_program.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

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
