// Stevens' power law from magnitude estimates, against R's lm and t.test.
#include "analysis/magnitudes/power_law.hpp"

#include <cmath>

#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/r_program.hpp"
using namespace tapstudy;
using analysis::Estimates;

namespace {
const std::vector<double> values{1.0, 2.0, 4.0, 8.0, 16.0};

Estimates estimates(double modulus, double exponent, const std::vector<double>& deviations) {
  Estimates result;
  for (std::size_t i = 0; i < values.size(); ++i) {
    result.push_back({values[i], modulus * std::pow(values[i], exponent) * deviations[i]});
  }
  return result;
}
}  // namespace

TEST_CASE("a participant's modulus does not change the exponent", "[analysis][magnitudes]") {
  const std::vector<double> exact(5, 1.0);
  const auto law = analysis::power_law({estimates(1.0, 0.8, exact), estimates(100.0, 0.8, exact)});
  CHECK(law.exponent == Approx(0.8).epsilon(1e-12));
  CHECK(*law.r_squared == Approx(1.0).epsilon(1e-12));
  CHECK(law.log_constant == Approx(1.0).epsilon(1e-12));  // the geometric mean of 1 and 100 is 10
  CHECK(law.exponent_interval->low == Approx(0.8).epsilon(1e-9));
  CHECK(law.exponent_interval->high == Approx(0.8).epsilon(1e-9));
  CHECK(law.means.front().geometric_mean == Approx(10.0).epsilon(1e-12));
}

TEST_CASE(
    "an exponent is R's regression of log geometric means, its interval a t test of "
    "participants' exponents",
    "[analysis][magnitudes]") {
  const std::vector<Estimates> participants{estimates(10.0, 0.7, {1.1, 0.9, 1.2, 1.0, 0.8}),
                                            estimates(3.0, 0.9, {0.7, 1.0, 1.1, 1.3, 1.0}),
                                            estimates(40.0, 0.6, {1.0, 1.2, 0.8, 1.1, 1.0}),
                                            estimates(9.0, 0.8, {1.3, 1.0, 1.0, 0.9, 1.1})};
  std::vector<double> all;
  for (const Estimates& one : participants) {
    for (const auto& estimate : one) {
      all.push_back(estimate.estimate);
    }
  }
  const std::vector<double> expected =
      testing::r_numbers("x <- log10(" + testing::r_vector(values) + "); y <- matrix(log10(" +
                         testing::r_vector(all) + R"(), nrow = 5)
g <- lm(rowMeans(y) ~ x); b <- apply(y, 2, function(one) coef(lm(one ~ x))[[2]])
out(coef(g)[[2]], coef(g)[[1]], summary(g)$r.squared, t.test(b)$conf.int, b)
out(10^rowMeans(y), apply(sweep(y, 2, colMeans(y)), 1, sd))
)");
  const auto law = analysis::power_law(participants);
  REQUIRE(expected.size() == 19);
  CHECK(law.exponent == Approx(expected[0]).epsilon(1e-10));
  CHECK(law.log_constant == Approx(expected[1]).epsilon(1e-10));
  CHECK(*law.r_squared == Approx(expected[2]).epsilon(1e-10));
  CHECK(law.exponent_interval->low == Approx(expected[3]).epsilon(1e-10));
  CHECK(law.exponent_interval->high == Approx(expected[4]).epsilon(1e-10));
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(law.participant_exponents[i] == Approx(expected[5 + i]).epsilon(1e-10));
  }
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK(law.means[i].value == Approx(values[i]).epsilon(1e-12));
    CHECK(law.means[i].geometric_mean == Approx(expected[9 + i]).epsilon(1e-10));
    CHECK(law.means[i].log_standard_deviation == Approx(expected[14 + i]).epsilon(1e-10));
  }
}

TEST_CASE("repeated estimates of a value count as their geometric mean", "[analysis][magnitudes]") {
  const Estimates once{{1.0, 2.0}, {10.0, 6.0}};
  const Estimates repeated{{1.0, 1.0}, {10.0, 6.0}, {1.0, 4.0}};
  const auto law = analysis::power_law({once, repeated});
  CHECK(law.participant_exponents[0] == Approx(std::log10(3.0)).epsilon(1e-12));
  CHECK(law.participant_exponents[1] == Approx(std::log10(3.0)).epsilon(1e-12));
}

TEST_CASE("magnitudes without a logarithm or a slope are refused", "[analysis][magnitudes]") {
  const Estimates fine{{1.0, 2.0}, {10.0, 6.0}};
  CHECK_THROWS_AS(analysis::power_law({}), core::InvalidInput);
  CHECK_THROWS_AS(analysis::power_law({fine, {{1.0, 2.0}}}), core::InvalidInput);
  CHECK_THROWS_AS(analysis::power_law({fine, {{1.0, 2.0}, {2.0, 0.0}}}), core::InvalidInput);
  CHECK_THROWS_WITH(analysis::power_law({fine, {{1.0, 2.0}, {20.0, 5.0}}}),
                    Contains("the same values"));
  CHECK_THROWS_AS(analysis::power_law({fine, {{-1.0, 2.0}, {2.0, 1.0}}}), core::InvalidInput);
}

TEST_CASE("one participant has an exponent without an interval, and equal numbers no R squared",
          "[analysis][magnitudes]") {
  const auto law = analysis::power_law({{{1.0, 2.0}, {10.0, 6.0}}});
  CHECK(law.exponent == Approx(std::log10(3.0)).epsilon(1e-12));
  CHECK_FALSE(law.exponent_interval);
  const auto flat = analysis::power_law({{{1.0, 5.0}, {10.0, 5.0}}});
  CHECK(flat.exponent == 0.0);
  CHECK_FALSE(flat.r_squared);
}
