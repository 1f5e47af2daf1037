// Intervals and goodness of fit of psychometric functions, against R's glm and chi-squared.
#include "analysis/statistics/psychometric/inference.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <sstream>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/psychometric/example_levels.hpp"
#include "analysis/statistics/psychometric/likelihood.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
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

// Posteriors of psychometric functions, against SciPy's beta-binomial distribution and maximum
// likelihood.
using analysis::FitOutcome;

namespace {
std::vector<double> python_numbers(const std::string& script) {
  const auto run = testing::run_program({"/usr/bin/python3", "-c", script});
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  std::istringstream words{run.standard_output};
  return {std::istream_iterator<double>{words}, {}};
}

void check_interval(const analysis::Interval& ours, const analysis::Interval& theirs,
                    double tolerance) {
  const double width = theirs.high - theirs.low;
  CHECK(ours.low == Approx(theirs.low).margin(tolerance * width));
  CHECK(ours.high == Approx(theirs.high).margin(tolerance * width));
}
}  // namespace

TEST_CASE("over-dispersed answers have SciPy's beta-binomial probabilities",
          "[analysis][psychometric]") {
  const std::vector<double> expected = python_numbers(R"(
from scipy.stats import betabinom
from scipy.special import comb
from math import log
for eta in (0.01, 0.2, 0.7):
    nu = 1 / eta**2 - 1
    for k, n, p in ((0, 10, .3), (7, 10, .6), (40, 40, .99)):
        print(repr(betabinom.logpmf(k, n, nu * p, nu * (1 - p)) - log(comb(n, k))))
)");
  REQUIRE(expected.size() == 9);
  std::size_t next = 0;
  for (const double eta : {0.01, 0.2, 0.7}) {
    for (const auto& [answers, p] : {std::pair{analysis::Proportion{0, 10}, 0.3},
                                     {analysis::Proportion{7, 10}, 0.6},
                                     {analysis::Proportion{40, 40}, 0.99}}) {
      CHECK(analysis::beta_binomial_log_likelihood(answers, p, eta) ==
            Approx(expected[next++]).epsilon(1e-9));
    }
  }
  const std::vector<analysis::Level> levels{{1.0, {0, 10}}, {2.0, {7, 10}}, {3.0, {40, 40}}};
  analysis::BetaBinomialLikelihood likelihood{levels, Eigen::Array3d{0.01, 0.2, 0.7}};
  const Eigen::ArrayXd together = likelihood.log_likelihoods({0.3, 0.6, 0.99});
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(together[static_cast<Eigen::Index>(i)] ==
          Approx(expected[3 * i] + expected[3 * i + 1] + expected[3 * i + 2]).epsilon(1e-9));
  }
  CHECK(analysis::beta_binomial_log_likelihood({7, 10}, 0.6, 0.0) ==
        Approx(7.0 * std::log(0.6) + 3.0 * std::log(0.4)).epsilon(1e-12));
}

TEST_CASE("priors are even within the levels' range and half as high midway to where they end",
          "[analysis][psychometric]") {
  const analysis::AxisRange range{10.0, 18.0, 1.0};
  const double half = std::log(0.5);
  for (const double inside : {10.0, 13.0, 18.0}) {
    CHECK(analysis::log_prior_of_position(inside, range) == 0.0);
  }
  CHECK(analysis::log_prior_of_position(8.0, range) == Approx(half).epsilon(1e-9));
  CHECK(analysis::log_prior_of_position(20.0, range) == Approx(half).epsilon(1e-9));
  CHECK(std::isinf(analysis::log_prior_of_position(6.0, range)));
  CHECK(std::isinf(analysis::log_prior_of_position(22.5, range)));
  for (const double inside : {2.0, 5.0, 8.0}) {
    CHECK(analysis::log_prior_of_width(inside, range) == 0.0);
  }
  CHECK(analysis::log_prior_of_width(1.5, range) == Approx(half).epsilon(1e-9));
  CHECK(analysis::log_prior_of_width(16.0, range) == Approx(half).epsilon(1e-9));
  CHECK(std::isinf(analysis::log_prior_of_width(0.9, range)));
  CHECK(std::isinf(analysis::log_prior_of_width(24.0, range)));
}

TEST_CASE("a posterior is the one that SciPy sums over a fixed grid", "[analysis][psychometric]") {
  // where the posterior of these answers is, in cells of its own
  const std::vector<double> expected = python_numbers(R"(
import numpy as np
from scipy.special import betaln
from scipy.stats import norm, beta
x = np.array([1, 2, 3, 4, 5.5, 7]); k = np.array([1, 6, 17, 27, 36, 39]); n = 40
def cells(low, high, m):
    e = np.linspace(low, high, m + 1)
    return (e[1:] + e[:-1]) / 2
t, w, l, e = cells(2, 5, 36), cells(1.001, 12, 50), cells(0, 0.1, 10), cells(0, 0.5, 40)
fall = lambda d: np.where(d >= 1, 0, 0.5 * (1 + np.cos(np.pi * np.clip(d, 0, 1))))
prior_t = fall(np.maximum(0, np.maximum(1 - t, t - 7)) / 3)
prior_w = fall(2 - w) * fall((w - 6) / 12)
T, W, L, E = np.meshgrid(t, w, l, e, indexing='ij', sparse=True)
log = (np.log(prior_t)[:, None, None, None] + np.log(prior_w)[None, :, None, None]
       + beta.logpdf(L, 1, 10) + beta.logpdf(E, 1, 10))
nu = 1 / E**2 - 1
for xi, ki in zip(x, k):
    p = (1 - L) * norm.cdf((xi - T) / W * 2 * norm.ppf(0.95))
    p = np.clip(p, 1e-12, 1 - 1e-12)
    log = log + betaln(ki + nu * p, n - ki + nu * (1 - p)) - betaln(nu * p, nu * (1 - p))
post = np.exp(log - log.max()); post /= post.sum()
def tell(axis, centres, of=lambda v: v):
    m = post.sum(axis=tuple(i for i in range(4) if i != axis)); v = of(centres)
    mean = (m * v).sum()
    h = centres[1] - centres[0]
    q = np.interp([0.025, 0.5, 0.975], np.concatenate([[0], m.cumsum()]),
                  np.concatenate([[centres[0] - h / 2], centres + h / 2]))
    print(mean, np.sqrt((m * (v - mean)**2).sum()), *of(q))
tell(0, t); tell(1, w, np.log); tell(2, l); tell(3, e)
)");
  REQUIRE(expected.size() == 20);
  const auto posterior = analysis::psychometric_posterior(
      {PsychometricShape::cumulative_gaussian, {0.0, 0.0}, {0.0, 0.1}}, yes_no_levels);
  REQUIRE(posterior.estimates);
  std::size_t next = 0;
  for (const auto& ours : {posterior.estimates->position, posterior.estimates->log_width,
                           posterior.estimates->lapse, posterior.estimates->eta}) {
    const double spread = expected[next + 1];
    INFO("row " << next / 5);
    CHECK(ours.mean == Approx(expected[next]).margin(0.03 * spread));  // cells differ
    CHECK(ours.standard_deviation == Approx(spread).epsilon(0.02));
    CHECK(ours.credible.low == Approx(expected[next + 2]).margin(0.04 * spread));
    CHECK(ours.median == Approx(expected[next + 3]).margin(0.04 * spread));
    CHECK(ours.credible.high == Approx(expected[next + 4]).margin(0.04 * spread));
    next += 5;
  }
}

TEST_CASE("with many answers a posterior is where the likelihood is", "[analysis][psychometric]") {
  for (const auto shape : {PsychometricShape::logistic, PsychometricShape::weibull}) {
    INFO(core::row_of(shape).name);
    const PsychometricModel model{shape, {0.0, 0.0}, {0.0, 0.0}};
    std::vector<Level> many;
    for (const double x : {1.0, 1.6, 2.2, 2.8, 3.4, 4.0, 4.6, 5.2, 5.8, 6.4, 7.0, 7.6}) {
      const double p = core::proportion(shape, x, 3.5, 2.0, 0.0, 0.0);
      many.push_back({x, {std::llround(1000.0 * p), 1000}});
    }
    const auto posterior = analysis::psychometric_posterior(model, many);
    const auto profile = analysis::profile_intervals(model, many);
    REQUIRE(posterior.estimates);
    CHECK(posterior.estimates->threshold == Approx(3.5).epsilon(0.01));
    CHECK(posterior.estimates->slope == Approx(2.0).epsilon(0.02));
    // eta is not known to be 0, which widens them a little
    check_interval(posterior.estimates->threshold_interval, profile.threshold, 0.25);
    check_interval(posterior.estimates->slope_interval, profile.slope, 0.25);
    CHECK(posterior.estimates->eta.median < 0.05);
    CHECK(posterior.estimates->guess.standard_deviation == 0.0);
  }
}

TEST_CASE("answers that vary more than binomial ones have a greater eta and a wider interval",
          "[analysis][psychometric]") {
  const PsychometricModel model{PsychometricShape::logistic, {0.0, 0.0}, {0.0, 0.05}};
  std::vector<Level> even;
  std::vector<Level> uneven;
  for (int i = 0; i < 10; ++i) {
    const double p = core::proportion(model.shape, i, 4.5, 0.8, 0.0, 0.0);
    const std::int64_t successes = std::llround(60.0 * p);
    const std::int64_t off = (i % 2 == 0 ? 1 : -1) * (i > 1 && i < 8 ? 12 : 0);
    even.push_back({1.0 * i, {successes, 60}});
    uneven.push_back({1.0 * i, {std::clamp<std::int64_t>(successes + off, 0, 60), 60}});
  }
  const auto from_even = analysis::psychometric_posterior(model, even).estimates;
  const auto from_uneven = analysis::psychometric_posterior(model, uneven).estimates;
  REQUIRE(from_even);
  REQUIRE(from_uneven);
  CHECK(from_uneven->eta.credible.low > from_even->eta.credible.high);
  CHECK(from_uneven->position.standard_deviation > 1.5 * from_even->position.standard_deviation);
}

TEST_CASE("a posterior of answers without a threshold has none either, that of a step has",
          "[analysis][psychometric]") {
  const PsychometricModel model{PsychometricShape::logistic, {0.0, 0.0}, {0.0, 0.1}};
  const auto right = analysis::psychometric_posterior(model, {{1.0, {9, 9}}, {2.0, {9, 9}}});
  CHECK(right.outcome == FitOutcome::all_successes);
  CHECK_FALSE(right.estimates);
  const auto step = analysis::psychometric_posterior(
      model, {{1.0, {0, 20}}, {2.0, {0, 20}}, {3.0, {20, 20}}, {4.0, {20, 20}}});
  CHECK(step.outcome == FitOutcome::fitted);
  REQUIRE(step.estimates);
  CHECK(step.estimates->threshold == Approx(2.5).margin(0.05));
  CHECK(step.estimates->threshold_interval.low > 1.5);
  CHECK_THROWS_AS(analysis::psychometric_posterior(model, {{1.0, {9, 9}}}), core::InvalidInput);
  CHECK_THROWS_AS(analysis::psychometric_posterior(model, yes_no_levels, 0.0), core::InvalidInput);
}

TEST_CASE("a threshold of answers that may all be guesses has no upper limit",
          "[analysis][psychometric]") {
  const PsychometricModel model{PsychometricShape::weibull, {0.5, 0.5}, {0.0, 0.1}};
  const std::vector<Level> few{{0.2, {2, 5}}, {0.5, {3, 5}}, {1.0, {4, 5}}};
  std::vector<Level> many = few;
  for (Level& level : many) {
    level.answers.successes *= 20;
    level.answers.trials *= 20;
  }
  const auto of_few = *analysis::psychometric_posterior(model, few, 0.95, 3.0).estimates;
  const auto of_many = *analysis::psychometric_posterior(model, many, 0.95, 3.0).estimates;
  CHECK(of_few.guessing > 0.2);
  CHECK(std::isinf(of_few.threshold_interval.high));
  CHECK(of_many.guessing < 0.001);
  CHECK(std::isfinite(of_many.threshold_interval.high));
}

namespace {
// Steps up and down by a factor, smaller after the first reversal.
struct Staircase {
  int right_to_descend{};
  double first_factor{};
  double factor{};
  int reversals{};
  int trials{};
};

std::vector<Level> levels_of(const Staircase& of, core::Rng& rng,
                             const std::function<double(double level)>& right) {
  std::map<double, analysis::Proportion> levels;
  double level = 1.0;
  int in_a_row = 0;
  int last = 0;
  int reversals = 0;
  for (int trial = 0; trial < of.trials && reversals < of.reversals; ++trial) {
    const bool is_right = rng.uniform() < right(level);
    levels[std::round(level * 1e9) / 1e9].add(is_right);
    in_a_row = is_right ? in_a_row + 1 : 0;
    const int direction = !is_right ? 1 : in_a_row == of.right_to_descend ? -1 : 0;
    if (direction == 0) {
      continue;
    }
    in_a_row = 0;
    reversals += direction * last < 0 ? 1 : 0;
    last = direction;
    const double factor = reversals == 0 ? of.first_factor : of.factor;
    level = std::clamp(direction > 0 ? level * factor : level / factor, 0.05, 3.0);
  }
  std::vector<Level> all;
  for (const auto& [value, answers] : levels) {
    all.push_back({value, answers});
  }
  return all;
}
}  // namespace

TEST_CASE("of 60 staircases of guesses at most 3 have a closed interval of the threshold",
          "[analysis][psychometric][slow]") {
  const PsychometricModel model{PsychometricShape::weibull, {0.5, 0.5}, {0.0, 0.1}};
  core::Rng rng{12};
  int closed = 0;
  for (int i = 0; i < 60; ++i) {
    const auto levels = levels_of({2, 1.5, 1.1, 8, 60}, rng, [](double /*level*/) { return 0.54; });
    const auto found = analysis::psychometric_posterior(model, levels, 0.95, 3.0).estimates;
    closed += found && std::isfinite(found->threshold_interval.high) ? 1 : 0;
  }
  CHECK(closed <= 3);
}

TEST_CASE("the posterior of a staircase holds a threshold also where the function is shallow",
          "[analysis][psychometric][slow]") {
  const PsychometricModel model{PsychometricShape::weibull, {0.5, 0.5}, {0.0, 0.1}};
  constexpr int tracks = 60;
  constexpr double threshold = 0.3;
  core::Rng rng{13};
  int held = 0;
  int found = 0;
  for (int i = 0; i < tracks; ++i) {
    const auto levels = levels_of({3, 1.58, 1.12, 1000, 60}, rng, [](double level) {
      return core::proportion(PsychometricShape::weibull, level, threshold, 0.8, 0.5, 0.0);
    });
    const auto of = analysis::psychometric_posterior(model, levels, 0.95, 3.0).estimates;
    found += of ? 1 : 0;
    held +=
        of && of->threshold_interval.low <= threshold && threshold <= of->threshold_interval.high
            ? 1
            : 0;
  }
  CHECK(found > 50);
  CHECK(held >= 0.92 * found - 2.0);  // with a breadth of 1 it is 48 of 57
}

TEST_CASE("a free guess rate is found", "[analysis][psychometric]") {
  std::vector<Level> levels;
  for (const double x : {-6.0, -4.0, -2.0, 0.0, 2.0, 4.0, 6.0}) {
    const double p = core::proportion(PsychometricShape::logistic, x, 0.0, 1.5, 0.2, 0.02);
    levels.push_back({x, {std::llround(400.0 * p), 400}});
  }
  const auto posterior = analysis::psychometric_posterior(
      {PsychometricShape::logistic, {0.0, 0.5}, {0.0, 0.1}}, levels);
  REQUIRE(posterior.estimates);
  CHECK(posterior.estimates->guess.median == Approx(0.2).margin(0.03));
  CHECK(posterior.estimates->lapse.median == Approx(0.02).margin(0.02));
}

TEST_CASE("the area below a posterior's density is 1, and 0.95 within its interval",
          "[analysis][psychometric]") {
  const auto posterior =
      analysis::psychometric_posterior({PsychometricShape::logistic}, yes_no_levels);
  REQUIRE(posterior.estimates);
  const analysis::Marginal& marginal = posterior.estimates->position;
  REQUIRE(marginal.at.size() > 10);
  REQUIRE(marginal.at.size() == marginal.density.size());
  const double cell = marginal.at[1] - marginal.at[0];
  double area = 0.0;
  double within = 0.0;
  for (std::size_t i = 0; i < marginal.at.size(); ++i) {
    const double overlap = std::min(marginal.at[i] + 0.5 * cell, marginal.credible.high) -
                           std::max(marginal.at[i] - 0.5 * cell, marginal.credible.low);
    area += marginal.density[i] * cell;
    within += marginal.density[i] * std::max(0.0, overlap);
  }
  CHECK(area == Approx(1.0).epsilon(1e-9));
  CHECK(within == Approx(0.95).margin(1e-9));
  CHECK(posterior.estimates->guess.density.empty());  // known
}
