#include "analysis/statistics/proportion.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/numerics.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double max_outcomes = 1e6;

double log_probability(const std::vector<int>& counts, int total) {
  double log_p = log_factorial(total) - total * std::log(static_cast<double>(counts.size()));
  for (const int count : counts) {
    log_p -= log_factorial(count);
  }
  return log_p;
}

// Calls visit with every way to put `left` observations into the classes from `place` on.
void each_outcome(std::vector<int>& counts, std::size_t place, int left,
                  const std::function<void(const std::vector<int>&)>& visit) {
  if (place + 1 == counts.size()) {
    counts[place] = left;
    visit(counts);
    return;
  }
  for (int here = 0; here <= left; ++here) {
    counts[place] = here;
    each_outcome(counts, place + 1, left - here, visit);
  }
}
}  // namespace

Proportion sum(const std::vector<Proportion>& parts) {
  Proportion all;
  for (const Proportion& part : parts) {
    all.successes += part.successes;
    all.trials += part.trials;
  }
  return all;
}

Interval wilson_interval(const Proportion& proportion) {
  const double z = boost::math::quantile(boost::math::normal{}, 0.975);
  const auto n = static_cast<double>(proportion.trials);
  const double p = proportion.value();
  const double centre = p + z * z / (2.0 * n);
  const double reach = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
  const double scale = 1.0 + z * z / n;
  return {proportion.successes == 0 ? 0.0 : (centre - reach) / scale,
          proportion.successes == proportion.trials ? 1.0 : (centre + reach) / scale};
}

Interval exact_interval(const Proportion& proportion) {
  constexpr double tail = 0.025;
  const auto right = static_cast<double>(proportion.successes);
  const auto wrong = static_cast<double>(proportion.trials - proportion.successes);
  return {right > 0.0 ? beta_quantile(tail, right, wrong + 1.0) : 0.0,
          wrong > 0.0 ? beta_quantile(1.0 - tail, right + 1.0, wrong) : 1.0};
}

double binomial_p_at_least(const Proportion& observed, double chance) {
  if (observed.successes <= 0) {
    return 1.0;
  }
  if (observed.successes > observed.trials) {
    return 0.0;
  }
  const boost::math::binomial_distribution<> guesses{static_cast<double>(observed.trials), chance};
  return boost::math::cdf(
      boost::math::complement(guesses, static_cast<double>(observed.successes - 1)));
}

std::optional<double> exact_multinomial_p(const std::vector<int>& counts) {
  const int total = std::accumulate(counts.begin(), counts.end(), 0);
  const int classes = static_cast<int>(counts.size());
  const double log_outcomes =
      log_factorial(total + classes - 1) - log_factorial(classes - 1) - log_factorial(total);
  if (log_outcomes > std::log(max_outcomes)) {
    return std::nullopt;
  }
  // equal probabilities differ by rounding
  const double limit = log_probability(counts, total) + 1e-9;
  double p = 0.0;
  std::vector<int> outcome(counts.size(), 0);
  each_outcome(outcome, 0, total, [&](const std::vector<int>& candidate) {
    const double log_p = log_probability(candidate, total);
    p += log_p <= limit ? std::exp(log_p) : 0.0;
  });
  return std::min(1.0, p);
}

int critical_successes(int trials, double chance, double alpha) {
  int fewest = 0;
  int most = trials + 1;
  while (fewest < most) {
    const int middle = fewest + (most - fewest) / 2;
    if (binomial_p_at_least({middle, trials}, chance) <= alpha) {
      most = middle;
    } else {
      fewest = middle + 1;
    }
  }
  return fewest;
}

double binomial_power(int trials, double chance, double alpha, double truth) {
  const int critical = critical_successes(trials, chance, alpha);
  return critical > trials ? 0.0 : binomial_p_at_least({critical, trials}, truth);
}

std::vector<Interval> simultaneous_intervals(const std::vector<int>& counts) {
  const double all = std::accumulate(counts.begin(), counts.end(), 0.0);
  if (counts.size() < 2 || all <= 0.0 ||
      std::ranges::any_of(counts, [](int count) { return count < 0; })) {
    throw core::InvalidInput{"simultaneous intervals take counts of two classes or more"};
  }
  const double a = chi_squared_quantile(1.0 - 0.05 / static_cast<double>(counts.size()), 1.0);
  std::vector<Interval> intervals;
  for (const int count : counts) {
    const double n = count;
    const double centre = a + 2.0 * n;
    const double reach = std::sqrt(a * (a + 4.0 * n * (all - n) / all));
    const double scale = 2.0 * (all + a);
    intervals.push_back(
        {std::max(0.0, (centre - reach) / scale), std::min(1.0, (centre + reach) / scale)});
  }
  return intervals;
}

namespace {
double quantile_of(const std::optional<double>& degrees_of_freedom) {
  constexpr double upper = 0.975;
  return degrees_of_freedom ? t_quantile(upper, *degrees_of_freedom) : normal_quantile(upper);
}

struct Distance {
  double of_interval_end{};
  std::optional<double> degrees_of_freedom;
};

Distance distance_of_sum(const Distance& a, const Distance& b) {
  double variance = 0.0;
  double squares = 0.0;  // of variances, each over its degrees of freedom
  for (const Distance& one : {a, b}) {
    const double error = one.of_interval_end / quantile_of(one.degrees_of_freedom);
    variance += error * error;
    squares += one.degrees_of_freedom ? std::pow(error, 4) / *one.degrees_of_freedom : 0.0;
  }
  if (!std::isfinite(variance)) {
    return {std::numeric_limits<double>::infinity(), std::nullopt};
  }
  const std::optional<double> degrees_of_freedom =
      squares > 0.0 ? std::optional{variance * variance / squares} : std::nullopt;
  return {quantile_of(degrees_of_freedom) * std::sqrt(variance), degrees_of_freedom};
}
}  // namespace

IntervalEstimate independent_difference(const IntervalEstimate& a, const IntervalEstimate& b) {
  const double difference = b.value - a.value;
  const Distance below = distance_of_sum({b.value - b.interval.low, b.degrees_of_freedom},
                                         {a.interval.high - a.value, a.degrees_of_freedom});
  const Distance above = distance_of_sum({b.interval.high - b.value, b.degrees_of_freedom},
                                         {a.value - a.interval.low, a.degrees_of_freedom});
  return {difference, {difference - below.of_interval_end, difference + above.of_interval_end}};
}

IntervalEstimate independent_ratio(const IntervalEstimate& a, const IntervalEstimate& b) {
  const auto map = [](const IntervalEstimate& of, auto to) {
    return IntervalEstimate{
        to(of.value), {to(of.interval.low), to(of.interval.high)}, of.degrees_of_freedom};
  };
  const auto log = [](double value) { return std::log(value); };
  const auto exp = [](double value) { return std::exp(value); };
  return map(independent_difference(map(a, log), map(b, log)), exp);
}
}  // namespace tapstudy::analysis
