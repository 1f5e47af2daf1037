#include "analysis/statistics/proportion.hpp"

#include <algorithm>
#include <array>
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
constexpr double confidence = 0.95;

double poisson(int k, double mean) {
  if (mean == 0.0) {
    return k == 0 ? 1.0 : 0.0;
  }
  return std::exp(k * std::log(mean) - mean - log_factorial(k));
}

// P(low <= X <= high)
double poisson_within(int low, int high, double mean) {
  double sum = 0.0;
  for (int k = std::max(low, 0); k <= high; ++k) {
    sum += poisson(k, mean);
  }
  return sum;
}

// Moments of a Poisson variable of this mean, given that it lies from low to high.
struct Truncated {
  double mean{};
  double second{};  // central moments
  double third{};
  double fourth{};
  double within{};  // the probability that it does
};

// Computed from factorial moments mean^r P(low - r <= X <= high - r) / P(low <= X <= high).
Truncated truncated(int low, int high, double mean) {
  Truncated made;
  made.within = poisson_within(low, high, mean);
  std::array<double, 5> factorial{};
  for (int r = 1; r <= 4; ++r) {
    factorial[static_cast<std::size_t>(r)] =
        std::pow(mean, r) * poisson_within(low - r, high - r, mean) / made.within;
  }
  const double m = factorial[1];
  const double raw2 = factorial[2] + m;
  const double raw3 = factorial[3] + 3.0 * factorial[2] + m;
  const double raw4 = factorial[4] + 6.0 * factorial[3] + 7.0 * factorial[2] + m;
  made.mean = m;
  made.second = raw2 - m * m;
  made.third = raw3 - 3.0 * m * raw2 + 2.0 * m * m * m;
  made.fourth = raw4 - 4.0 * m * raw3 + 6.0 * m * m * raw2 - 3.0 * m * m * m * m;
  return made;
}

// The density at z of a sum with this skewness and excess, both of the sum (Edgeworth).
double edgeworth(double z, double skewness, double excess) {
  const double z2 = z * z;
  const double h3 = z * (z2 - 3.0);
  const double h4 = z2 * z2 - 6.0 * z2 + 3.0;
  const double h6 = z2 * z2 * z2 - 15.0 * z2 * z2 + 45.0 * z2 - 15.0;
  return normal_density(z) *
         (1.0 + skewness * h3 / 6.0 + excess * h4 / 24.0 + skewness * skewness * h6 / 72.0);
}

// P(|X_i - n_i| <= c for all i)
double all_within(const std::vector<int>& counts, int all, int c) {
  double product = 1.0;
  Truncated sum;
  for (const int count : counts) {
    const Truncated one = truncated(std::max(count - c, 0), std::min(count + c, all), count);
    product *= one.within;
    sum.mean += one.mean;
    sum.second += one.second;
    sum.third += one.third;
    sum.fourth += one.fourth - 3.0 * one.second * one.second;
  }
  const double spread = std::sqrt(sum.second);
  const double density = edgeworth((all - sum.mean) / spread, sum.third / std::pow(spread, 3),
                                   sum.fourth / std::pow(spread, 4)) /
                         spread;
  return product * density / poisson(all, all);
}
}  // namespace

std::vector<Interval> sison_glaz_intervals(const std::vector<int>& counts) {
  const int all = std::accumulate(counts.begin(), counts.end(), 0);
  if (counts.size() < 2 || all <= 0 ||
      std::ranges::any_of(counts, [](int count) { return count < 0; })) {
    throw core::InvalidInput{"simultaneous intervals take counts of two classes or more"};
  }
  double before = 0.0;
  double now = all_within(counts, all, 1);
  int c = 1;
  while (c < all && now <= confidence) {
    before = now;
    now = all_within(counts, all, ++c);
  }
  const double part = std::clamp((confidence - before) / (now - before), 0.0, 1.0);
  std::vector<Interval> intervals;
  for (const int count : counts) {
    intervals.push_back({std::max(0.0, static_cast<double>(count - c + 1) / all),
                         std::min(1.0, (count + c - 1 + 2.0 * part) / all)});
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
