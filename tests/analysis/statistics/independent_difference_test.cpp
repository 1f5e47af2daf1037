#include "analysis/statistics/independent_difference.hpp"

#include <catch2/catch.hpp>
using namespace tapstudy::analysis;

// Newcombe 1998 (Statistics in Medicine 17, 873-890), Table II, method 10: 56/70 less 48/80.
TEST_CASE("differences of proportions have Newcombe's interval", "[analysis][proportion]") {
  const auto estimate = [](const Proportion& proportion) {
    return IntervalEstimate{proportion.value(), wilson_interval(proportion)};
  };
  const IntervalEstimate difference =
      independent_difference(estimate({48, 80}), estimate({56, 70}));
  CHECK(difference.value == Approx(0.2));
  CHECK(difference.interval.low == Approx(0.0524).margin(0.00005));
  CHECK(difference.interval.high == Approx(0.3339).margin(0.00005));
}

TEST_CASE("a difference the other way round is its negative", "[analysis][proportion]") {
  const IntervalEstimate a{1.0, {0.2, 1.3}};
  const IntervalEstimate b{4.0, {3.1, 6.0}};
  const IntervalEstimate forth = independent_difference(a, b);
  const IntervalEstimate back = independent_difference(b, a);
  CHECK(forth.value == -back.value);
  CHECK(forth.interval.low == Approx(-back.interval.high));
  CHECK(forth.interval.high == Approx(-back.interval.low));
}
