// The mean of people who differ, against statsmodels.
#include "analysis/participants/random_effects.hpp"

#include <cmath>

#include "core/error.hpp"
#include "core/rng.hpp"
#include "support/catch.hpp"
#include "support/python_program.hpp"
using namespace tapstudy;
using analysis::random_effects;
using analysis::RandomEffects;

TEST_CASE("the mean, its interval and the spread of people are those of statsmodels",
          "[analysis][participants]") {
  const std::vector<double> values{0.31, -0.12, 0.55, 0.02, 0.78, 0.21};
  const std::vector<double> errors{0.08, 0.12, 0.20, 0.05, 0.30, 0.10};
  const std::vector<double> expected = testing::python_numbers(R"py(
import numpy as np
from scipy import stats
from statsmodels.stats.meta_analysis import combine_effects
errors = np.array([0.08, 0.12, 0.20, 0.05, 0.30, 0.10])
found = combine_effects(np.array([0.31, -0.12, 0.55, 0.02, 0.78, 0.21]), errors**2, method_re="iterated")
half = stats.t.ppf(0.975, 5) * found.sd_eff_w_re_hksj
out(found.mean_effect_re, np.sqrt(found.tau2), found.mean_effect_re - half, found.mean_effect_re + half)
)py");
  const RandomEffects found = random_effects(values, errors);
  REQUIRE(expected.size() == 4);
  CHECK(found.mean == Approx(expected[0]).epsilon(1e-4));  // which iterates to 1e-5
  CHECK(found.between_sd == Approx(expected[1]).epsilon(1e-4));
  CHECK(found.interval.low == Approx(expected[2]).epsilon(1e-3));
  CHECK(found.interval.high == Approx(expected[3]).epsilon(1e-3));
}

TEST_CASE("people who differ no more than their errors are taken as alike",
          "[analysis][participants]") {
  const RandomEffects found = random_effects({1.0, 1.1, 0.9}, {0.5, 0.5, 0.5});
  CHECK(found.between_sd == 0.0);
  CHECK(found.mean == Approx(1.0));
  // not narrower than three known errors allow: t of two degrees of freedom
  CHECK(found.interval.high - found.mean == Approx(4.302652730 * 0.5 / std::sqrt(3.0)));
}

TEST_CASE("the interval holds the mean of people at its rate", "[analysis][participants]") {
  core::Rng rng{5};
  constexpr int studies = 2000;
  int held = 0;
  for (int study = 0; study < studies; ++study) {
    std::vector<double> values;
    std::vector<double> errors;
    for (int person = 0; person < 8; ++person) {
      errors.push_back(0.05 + 0.3 * rng.uniform());
      values.push_back(2.0 + 0.2 * rng.normal() + errors.back() * rng.normal());
    }
    const RandomEffects found = random_effects(values, errors);
    held += found.interval.low <= 2.0 && 2.0 <= found.interval.high ? 1 : 0;
  }
  CHECK(held / static_cast<double>(studies) == Approx(0.95).margin(0.02));
}

TEST_CASE("values without errors have no random effects", "[analysis][participants]") {
  CHECK_THROWS_AS(random_effects({1.0}, {0.1}), core::InvalidInput);
  CHECK_THROWS_AS(random_effects({1.0, 2.0}, {0.1}), core::InvalidInput);
  CHECK_THROWS_AS(random_effects({1.0, 2.0}, {0.1, 0.0}), core::InvalidInput);
  CHECK_THROWS_AS(random_effects({1.0, 2.0}, {0.1, std::nan("")}), core::InvalidInput);
}
