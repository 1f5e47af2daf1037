#include "analysis/statistics/detection/decision_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/numerics.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using std::numbers::pi;
using std::numbers::sqrt2;
using std::numbers::sqrt3;
constexpr double reach = 9.0;  // standard deviations; what lies beyond is below 1e-18

// P(the signal's observation is the greatest of m).
double greatest_of(double d_prime, int alternatives) {
  return integral(
      [&](double x) {
        return normal_density(x - d_prime) * std::pow(normal_cdf(x), alternatives - 1);
      },
      d_prime - reach, d_prime + reach);
}

// Frijters 1979: x = |difference of the two that are alike| / sqrt 2; the odd one must lie further
// than 3/2 of their difference from their mean.
double triangle(double d_prime) {
  const double shift = d_prime * sqrt2 / sqrt3;
  return 2.0 * integral(
                   [&](double x) {
                     return normal_density(x) *
                            (normal_cdf(shift - x * sqrt3) + normal_cdf(-shift - x * sqrt3));
                   },
                   0.0, reach);
}

// The probability of a correct answer among four observations, of which y is odd. Sorted, the other
// three are a < b < c. Above them, y is furthest from the mean of all if y - c > b - a. With u = b
// - a, v = c - b the differences have the joint density below (3! orders), and y - c given them is
// Gaussian with mean d' - (u + 2v)/3 and variance 4/3. Below them it is the same with -d'.
double odd_of_four(double d_prime) {
  const auto at = [&](double u, double v) {
    const double density = 6.0 * std::exp(-(u * u + u * v + v * v) / 3.0) / (2.0 * pi * sqrt3);
    const double edge = (4.0 * u + 2.0 * v) / 3.0;
    return density * (normal_cdf((d_prime - edge) * sqrt3 / 2.0) +
                      normal_cdf((-d_prime - edge) * sqrt3 / 2.0));
  };
  constexpr double widest = 13.0;
  return integral(
      [&](double u) { return integral([&](double v) { return at(u, v); }, 0.0, widest); }, 0.0,
      widest);
}

double furthest_of(double d_prime, int alternatives) {
  return alternatives == 3 ? triangle(d_prime) : odd_of_four(d_prime);
}

// Both of two independent Gaussian decisions right, or both wrong.
double both_or_neither(double first, double second) {
  return normal_cdf(first) * normal_cdf(second) + normal_cdf(-first) * normal_cdf(-second);
}

double nearer_of_two(double d_prime, int) {
  return both_or_neither(d_prime / sqrt2, d_prime / std::sqrt(6.0));
}

double likelier_of_two(double d_prime, int) {
  return both_or_neither(d_prime / sqrt2, d_prime / 2.0);
}

double likelier_of_four(double d_prime, int) {
  return both_or_neither(d_prime / 2.0, d_prime / 2.0);
}

using enum DecisionModel;
constexpr int many = 1000;
constexpr std::array models{
    DecisionModelRow{forced_choice, "forced_choice", 2, many, greatest_of,
                     "m-alternative forced choice: the greatest observation"},
    DecisionModelRow{oddity, "oddity", 3, 4, furthest_of,
                     "odd one out: the observation furthest from the mean of all"},
    DecisionModelRow{abx_differencing, "abx_differencing", 2, 2, nearer_of_two,
                     "ABX, matching to sample: the nearer of two observations"},
    DecisionModelRow{abx_independent_observation, "abx_independent_observation", 2, 2,
                     likelier_of_two, "ABX, matching to sample: the likelier answer"},
    DecisionModelRow{same_different_independent_observation,
                     "same_different_independent_observation", 2, 2, likelier_of_four,
                     "same or different: the likelier answer"},
};

const DecisionModelRow& row_of(const DecisionTask& task) {
  const DecisionModelRow& row = models.at(static_cast<std::size_t>(task.model));
  if (task.alternatives < row.fewest_alternatives || task.alternatives > row.most_alternatives) {
    throw core::InvalidInput{fmt::format("{} has {} to {} alternatives, not {}", row.name,
                                         row.fewest_alternatives, row.most_alternatives,
                                         task.alternatives)};
  }
  return row;
}
}  // namespace

std::span<const DecisionModelRow> decision_models() {
  return models;
}

const DecisionModelRow* find_decision_model(std::string_view name) {
  const auto* const found = std::ranges::find(models, name, &DecisionModelRow::name);
  return found == models.end() ? nullptr : &*found;
}

double chance(const DecisionTask& task) {
  row_of(task);
  return 1.0 / task.alternatives;
}

double proportion_correct(const DecisionTask& task, double d_prime) {
  const DecisionModelRow& row = row_of(task);
  if (!(d_prime >= 0.0) || !std::isfinite(d_prime)) {
    throw core::InvalidInput{fmt::format("d' is a finite number of at least 0, not {}", d_prime)};
  }
  return std::clamp(row.proportion_correct(d_prime, task.alternatives), 0.0, 1.0);
}

double d_prime_of(const DecisionTask& task, double proportion) {
  if (!(proportion >= 0.0 && proportion <= 1.0)) {
    throw core::InvalidInput{
        fmt::format("a proportion correct is between 0 and 1, not {}", proportion)};
  }
  if (proportion <= chance(task)) {
    return 0.0;
  }
  const auto excess = [&](double d_prime) {
    return proportion_correct(task, d_prime) - proportion;
  };
  if (proportion >= 1.0 || excess(max_d_prime) <= 0.0) {
    return std::numeric_limits<double>::infinity();
  }
  // quadrature at 0 may exceed chance in the last digits
  return excess(0.0) >= 0.0 ? 0.0 : root(excess, 0.0, max_d_prime);
}

Sensitivity sensitivity(const DecisionTask& task, const Proportion& correct) {
  if (correct.trials <= 0 || correct.successes < 0 || correct.successes > correct.trials) {
    throw core::InvalidInput{fmt::format("{} right answers in {} trials are not possible",
                                         correct.successes, correct.trials)};
  }
  Sensitivity result;
  result.is_below_chance = correct.value() < chance(task);
  result.is_perfect = correct.successes == correct.trials;
  const double half_wrong = 1.0 - 0.5 / static_cast<double>(correct.trials);
  result.d_prime = d_prime_of(task, result.is_perfect ? half_wrong : correct.value());
  const Interval score = wilson_interval(correct);
  result.interval = {d_prime_of(task, score.low), result.is_perfect
                                                      ? std::numeric_limits<double>::infinity()
                                                      : d_prime_of(task, score.high)};
  return result;
}
}  // namespace tapstudy::analysis
