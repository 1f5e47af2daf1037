// Intervals and goodness of fit of psychometric functions, against R's glm and chi-squared.
#include "analysis/psychometric/inference.hpp"

#include <cmath>

#include "analysis/psychometric/example_levels.hpp"
#include "analysis/statistics/distributions.hpp"
#include "core/error.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
using analysis::Level;
using analysis::PsychometricModel;
using core::PsychometricShape;
using testing::yes_no_levels;

namespace {
const PsychometricModel logistic{PsychometricShape::logistic, {0.0, 0.0}, {0.0, 0.0}};
}

TEST_CASE("profile intervals end where R's constrained models are worse by the quantile",
          "[analysis][psychometric]") {
  const std::vector<double> expected = testing::r_numbers(testing::r_levels(yes_no_levels) + R"(
y <- cbind(k, n - k); q <- qchisq(0.95, 1); control <- glm.control(epsilon = 1e-14)
for (link in c('logit', 'probit')) {
  f <- binomial(link); g <- glm(y ~ x, family = f, control = control)
  t <- -coef(g)[[1]] / coef(g)[[2]]; b <- coef(g)[[2]]
  at_t <- function(v) deviance(glm(y ~ 0 + I(x - v), family = f, control = control)) - deviance(g) - q
  at_b <- function(v) deviance(glm(y ~ offset(v * x), family = f, control = control)) - deviance(g) - q
  end <- function(h, from, to) uniroot(h, c(from, to), tol = 1e-12)$root
  out(end(at_t, t - 1, t), end(at_t, t, t + 1), end(at_b, 0.3 * b, b), end(at_b, b, 2 * b))
}
)");
  REQUIRE(expected.size() == 8);
  std::size_t next = 0;
  for (const auto shape : {PsychometricShape::logistic, PsychometricShape::cumulative_gaussian}) {
    const auto ours = analysis::profile_intervals({shape, {0.0, 0.0}, {0.0, 0.0}}, yes_no_levels);
    CHECK(ours.threshold.low == Approx(expected[next++]).epsilon(1e-9));
    CHECK(ours.threshold.high == Approx(expected[next++]).epsilon(1e-9));
    CHECK(ours.slope.low == Approx(expected[next++]).epsilon(1e-9));
    CHECK(ours.slope.high == Approx(expected[next++]).epsilon(1e-9));
  }
}

TEST_CASE("intervals are wider with free lapses and infinite where answers set no limit",
          "[analysis][psychometric]") {
  const auto known = analysis::profile_intervals(logistic, yes_no_levels);
  const auto free = analysis::profile_intervals(
      {PsychometricShape::logistic, {0.0, 0.0}, {0.0, 0.1}}, yes_no_levels);
  CHECK(free.threshold.low <= known.threshold.low);
  CHECK(free.slope.high >= known.slope.high);
  CHECK(analysis::profile_intervals(logistic, yes_no_levels, 0.5).slope.high < known.slope.high);

  const std::vector<Level> few{{1.0, {1, 4}}, {2.0, {2, 4}}, {3.0, {3, 4}}};
  const auto open = analysis::profile_intervals(logistic, few);
  CHECK(std::isinf(open.threshold.low));
  CHECK(std::isinf(open.threshold.high));
  CHECK(open.slope.low == 0.0);
}

TEST_CASE("with many trials a bootstrapped deviance is chi-squared", "[analysis][psychometric]") {
  constexpr int draws = 2000;
  // six levels, two parameters
  const std::vector<Level> levels{{1.0, {32, 400}},  {2.0, {75, 400}},  {3.0, {140, 400}},
                                  {4.0, {255, 400}}, {5.0, {340, 400}}, {6.0, {368, 400}}};
  const auto fit = analysis::fit_psychometric(logistic, levels);
  const auto test = analysis::deviance_test(logistic, levels, draws, 11);
  CHECK(test.deviance == fit.deviance);
  const double expected = analysis::chi_squared_p(fit.deviance, 4.0);
  REQUIRE(expected > 0.02);
  REQUIRE(expected < 0.98);
  CHECK(test.p == Approx(expected).margin(4.0 * std::sqrt(expected * (1.0 - expected) / draws)));
  CHECK(analysis::deviance_test(logistic, levels, draws, 11).p == test.p);
}

TEST_CASE("a bad fit has a small p, an exact one a p of 1", "[analysis][psychometric]") {
  std::vector<Level> uneven = yes_no_levels;
  uneven[2].answers.successes = 36;
  uneven[3].answers.successes = 12;
  CHECK(analysis::deviance_test(logistic, uneven, 199, 3).p == Approx(1.0 / 200.0).epsilon(1e-9));
  const std::vector<Level> two{{1.0, {10, 40}}, {2.0, {30, 40}}};
  CHECK(analysis::deviance_test(logistic, two, 199, 3).p == 1.0);
}

TEST_CASE("an interval is refused where there is no threshold", "[analysis][psychometric]") {
  const std::vector<Level> right{{1.0, {9, 9}}, {2.0, {9, 9}}};
  CHECK_THROWS_AS(analysis::profile_intervals(logistic, right), core::InvalidInput);
  CHECK_THROWS_AS(analysis::profile_intervals(logistic, yes_no_levels, 1.0), core::InvalidInput);
  CHECK_THROWS_AS(analysis::deviance_test(logistic, yes_no_levels, 0, 1), core::InvalidInput);
}
