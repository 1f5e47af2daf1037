#include "analysis/statistics/proportion.hpp"

#include <catch2/catch.hpp>

#include "analysis/blocks/wording.hpp"
#include "analysis/statistics/permutation_test.hpp"
#include "core/rng.hpp"
using namespace tapstudy::analysis;

// Numbers from SciPy 1.10: binomtest(k, n).proportion_ci(method="wilson"), binom.sf, and
// multinomial.pmf summed over all outcomes.

TEST_CASE("the Wilson interval is that of SciPy", "[analysis]") {
  const Interval five_of_eight = wilson_interval({5, 8});
  CHECK(five_of_eight.low == Approx(0.3057).margin(1e-4));
  CHECK(five_of_eight.high == Approx(0.8632).margin(1e-4));
  const Interval none = wilson_interval({0, 10});
  CHECK(none.low == 0.0);
  CHECK(none.high == Approx(0.2775).margin(1e-4));
  const Interval all = wilson_interval({10, 10});
  CHECK(all.low == Approx(0.7225).margin(1e-4));
  CHECK(all.high == Approx(1.0));
}

TEST_CASE("the Wilson interval solves its own equation", "[analysis]") {
  // (p - p0)² = z² p0 (1 - p0) / n at both ends
  const Proportion observed{43, 80};
  const Interval interval = wilson_interval(observed);
  for (const double end : {interval.low, interval.high}) {
    const double z2 = std::pow(observed.value() - end, 2) * 80.0 / (end * (1.0 - end));
    CHECK(std::sqrt(z2) == Approx(1.959964).epsilon(1e-6));
  }
}

TEST_CASE("so many right answers are needed against chance", "[analysis]") {
  CHECK(critical_successes(8, 0.25, 0.05) == 5);
  CHECK(binomial_p_at_least({5, 8}, 0.25) == Approx(0.027).margin(5e-4));
  CHECK(critical_successes(80, 0.25, 0.05) == 27);
  CHECK(binomial_p_at_least({27, 80}, 0.25) == Approx(0.0499).margin(5e-5));
  CHECK(binomial_p_at_least({7, 10}, 1.0 / 3.0) == Approx(0.020).margin(5e-4));
  CHECK(binomial_p_at_least({0, 10}, 0.25) == 1.0);
  CHECK(critical_successes(1, 0.25, 0.05) == 2);
  CHECK(binomial_power(1, 0.25, 0.05, 0.9) == 0.0);
}

TEST_CASE("the exact multinomial test orders outcomes by probability", "[analysis]") {
  CHECK(exact_multinomial_p({8, 1, 1}).value() == Approx(0.010).margin(5e-4));
  CHECK(exact_multinomial_p({7, 3, 0}).value() == Approx(0.022).margin(5e-4));
  CHECK(exact_multinomial_p({7, 2, 1}).value() == Approx(0.093).margin(5e-4));
  CHECK(exact_multinomial_p({6, 4, 0}).value() == Approx(0.044).margin(5e-4));
  CHECK(exact_multinomial_p({12, 5, 3}).value() == Approx(0.048).margin(5e-4));
  CHECK(exact_multinomial_p({4, 0, 0}).value() == Approx(3.0 / 81.0));  // all four chose the same
  CHECK(exact_multinomial_p({1, 1, 1}).value() == Approx(1.0));
  CHECK_FALSE(exact_multinomial_p({400, 0, 0, 0, 0, 0, 0, 0}).has_value());  // too many outcomes
}

TEST_CASE("p values are said as they are printed in papers", "[analysis][report]") {
  CHECK(p_value(0.0201) == "p = .020");
  CHECK(p_value(0.00001) == "p < .001");
  CHECK(p_value(1.0) == "p = 1.000");
  CHECK(p_value(0.99996) == "p = 1.000");
}
