// Psychometric functions of several people in one fit.
#include "analysis/statistics/psychometric/hierarchical.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <random>

#include "analysis/statistics/population/means.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "support/reference_programs.hpp"
using namespace tapstudy;
using analysis::fit_population;
using analysis::Level;
using analysis::PsychometricModel;
using core::PsychometricShape;

namespace {
const std::vector<double> values{0.02, 0.03, 0.045, 0.07, 0.1, 0.15, 0.22, 0.33, 0.5};
const PsychometricModel choice_of_two{PsychometricShape::log_gaussian, {0.5, 0.5}, {0.0, 0.0}};
using Answers = std::vector<std::vector<Level>>;

// In the proportions of a function; of a generator, drawn.
std::vector<Level> person(double threshold, double slope, int trials,
                          std::mt19937_64* generator = nullptr, double lapse = 0.0) {
  std::vector<Level> levels;
  for (const double value : values) {
    const double p =
        core::proportion(PsychometricShape::log_gaussian, value, threshold, slope, 0.5, lapse);
    const auto right = generator == nullptr
                           ? std::llround(p * trials)
                           : std::binomial_distribution<long long>{trials, p}(*generator);
    levels.push_back({value, {right, trials}});
  }
  return levels;
}
}  // namespace

TEST_CASE("of people who have answered much, the population has their t interval",
          "[analysis][psychometric]") {
  const std::vector<double> positions{-1.4, -1.2, -0.95, -0.9, -0.6};
  Answers people;
  for (const double position : positions) {
    people.push_back(person(std::pow(10.0, position), 5.0, 600));
  }
  const auto fit = fit_population(choice_of_two, people);
  REQUIRE(fit);
  const analysis::Interval by_t = analysis::t_interval(positions);
  const double width = by_t.high - by_t.low;
  CHECK(std::log10(fit->threshold) == Approx(-1.01).margin(0.01 * width));
  CHECK(std::log10(fit->interval.low) == Approx(by_t.low).margin(0.02 * width));
  CHECK(std::log10(fit->interval.high) == Approx(by_t.high).margin(0.02 * width));
  for (std::size_t i = 0; i < people.size(); ++i) {
    CHECK(std::log10(fit->people[i].threshold) == Approx(positions[i]).margin(0.02));
  }
}

// That each person's lapses are as likely as for anybody would make all thresholds too low.
TEST_CASE("people who lapse alike have the thresholds that they have where their lapses are known",
          "[analysis][psychometric]") {
  Answers people;
  for (const double position : {-1.35, -1.2, -1.12, -1.06, -1.0, -0.94, -0.88, -0.8, -0.65}) {
    people.push_back(person(std::pow(10.0, position), 3.0, 50, nullptr, 0.02));
  }
  PsychometricModel known = choice_of_two;
  known.lapse = {0.02, 0.02};
  PsychometricModel free = choice_of_two;
  free.lapse = {0.0, 0.1};
  const auto truth = fit_population(known, people);
  const auto fit = fit_population(free, people);
  REQUIRE((truth && fit));
  CHECK(std::log10(fit->threshold / truth->threshold) == Approx(0.0).margin(0.006));
}

// Of few answers the likelihood has several hills, between which the interval's end was looked for.
TEST_CASE("three people who answer little have an interval around their threshold",
          "[analysis][psychometric]") {
  const PsychometricModel model{PsychometricShape::weibull, {0.5, 0.5}, {0.0, 0.1}};
  core::Rng rng{GENERATE(16U, 22U)};
  Answers people(3);
  for (std::vector<Level>& levels : people) {
    const double threshold = rng.log_normal(1.0, 0.4);
    for (int step = -2; step <= 2; ++step) {
      const double value = std::pow(10.0, 0.25 * step);
      const double p =
          core::proportion(PsychometricShape::weibull, value, threshold, 2.0, 0.5, 0.02);
      analysis::Proportion of;
      for (int i = 0; i < 8; ++i) {
        of.add(rng.uniform() < p);
      }
      levels.push_back({value, of});
    }
  }
  const auto fit = fit_population(model, people);
  REQUIRE(fit);
  CHECK(fit->interval.low < fit->threshold);
  CHECK(fit->interval.high > fit->threshold);
}

// Integrated over a finer and wider grid, and climbed by another rule.
TEST_CASE(
    "no population is likelier than the fit, and its interval ends where SciPy's profile does",
    "[analysis][psychometric]") {
  std::mt19937_64 generator{5};
  Answers people;
  for (const double position : {-1.5, -1.2, -1.0, -0.8, -0.5}) {
    const double slope = std::exp(1.2 + std::normal_distribution{0.0, 0.8}(generator));
    people.push_back(person(std::pow(10.0, position), slope, 25, &generator));
  }
  const auto fit = fit_population(choice_of_two, people);
  REQUIRE(fit);
  std::vector<std::string> counts;
  for (const std::vector<Level>& levels : people) {
    std::vector<std::int64_t> right;
    for (const Level& level : levels) {
      right.push_back(level.answers.successes);
    }
    counts.push_back(fmt::format("[{}]", fmt::join(right, ",")));
  }
  const auto scipy = testing::python_numbers(fmt::format(
      R"(
from scipy.stats import norm, t
from scipy.optimize import minimize
x = np.log10([{}]); k = np.array([{}]); n = 25
m = np.linspace(-5, 2, 701); s = np.linspace(-3, 5, 161)
p = np.clip(.5 + .5 * norm.cdf(np.exp(s)[None, :, None] * (x - m[:, None, None])), 1e-15, 1 - 1e-15)
logs = np.tensordot(k, np.log(p), (1, 2)) + np.tensordot(n - k, np.log1p(-p), (1, 2))
top = logs.max((1, 2)); like = np.exp(logs - top[:, None, None])
def minus(mu, ln_tau, nu, ln_omega):
    of_m = norm.pdf(m, mu, np.exp(ln_tau)); of_s = norm.pdf(s, nu, np.exp(ln_omega))
    return -(np.log(of_m @ (like @ of_s).T / of_m.sum() / of_s.sum()) + top).sum()
full = minimize(lambda v: minus(*v), [{}, {}, {}, {}], method='Nelder-Mead', options=dict(xatol=1e-4, fatol=1e-6))
out(full.x[0], np.exp(full.x[1]), full.x[2], np.exp(full.x[3]))
N = len(k); out(N * np.log1p(t.ppf(.975, N - 1)**2 / (N - 1)))
for mu in ({}, {}):
    at = minimize(lambda v: minus(mu, *v), full.x[1:], method='Nelder-Mead', options=dict(xatol=1e-4, fatol=1e-6))
    out(2 * (at.fun - full.fun))
)",
      fmt::join(values, ","), fmt::join(counts, ","), std::log10(fit->threshold),
      std::log(fit->deviation), fit->log_slope, std::log(fit->slope_deviation),
      std::log10(fit->interval.low), std::log10(fit->interval.high)));
  REQUIRE(scipy.size() == 7);
  CHECK(std::log10(fit->threshold) == Approx(scipy[0]).margin(0.003));
  CHECK(fit->deviation == Approx(scipy[1]).epsilon(0.01));
  CHECK(fit->log_slope == Approx(scipy[2]).margin(0.02));
  CHECK(fit->slope_deviation == Approx(scipy[3]).epsilon(0.03));
  CHECK(scipy[5] == Approx(scipy[4]).margin(0.03));
  CHECK(scipy[6] == Approx(scipy[4]).margin(0.03));
}

TEST_CASE("who is never right beyond chance, or nearly always, is in the fit of all",
          "[analysis][psychometric]") {
  Answers people{person(0.08, 4.0, 20), person(0.12, 4.0, 20), person(0.15, 4.0, 20),
                 person(0.2, 4.0, 20)};
  const auto without = fit_population(choice_of_two, people);
  people.push_back(person(50.0, 4.0, 20));  // half of the answers right at every level
  const auto with = fit_population(choice_of_two, people);
  REQUIRE((without && with));
  CHECK(with->threshold > without->threshold);
  CHECK(with->deviation > without->deviation);
  CHECK(with->people.back().threshold > values.back());
  CHECK(std::isfinite(with->interval.high));
  people.back() = person(1e-4, 4.0, 20);
  CHECK(fit_population(choice_of_two, people)->people.back().threshold < values.front());
}

TEST_CASE("a population whose mean the levels do not reach has no fit, nor have two people",
          "[analysis][psychometric]") {
  CHECK_FALSE(fit_population(choice_of_two, Answers(5, person(50.0, 4.0, 20))));
  CHECK_FALSE(fit_population(choice_of_two, Answers(2, person(0.1, 4.0, 20))));
  CHECK_FALSE(fit_population(choice_of_two, Answers(3, {{0.1, {3, 4}}})));
  CHECK_THROWS_AS(fit_population(choice_of_two, Answers(3, {{0.1, {5, 4}}, {0.2, {1, 4}}})),
                  core::InvalidInput);
}
