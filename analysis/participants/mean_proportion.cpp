#include "analysis/participants/mean_proportion.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/participants/beta_binomial_score.hpp"
#include "analysis/psychometric/beta_binomial.hpp"
#include "analysis/resampling/replicates.hpp"
#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/numerics.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "core/error.hpp"
#include "core/rng.hpp"
namespace tapstudy::analysis {
namespace {
constexpr int bootstrap_draws = 4999;
constexpr std::uint64_t bootstrap_seed = 2;
constexpr double largest_eta = 0.999;  // square root of the intra-class correlation
constexpr double smallest_share = 1e-9;
constexpr double indistinguishable = 1e-5;  // log likelihoods, by rounding where eta is small

double log_likelihood(const std::vector<Proportion>& participants, double mean, double eta) {
  double sum = 0.0;
  for (const Proportion& of : participants) {
    sum += beta_binomial_log_likelihood(of, mean, eta);
  }
  return sum;
}

struct Profile {
  double eta{};
  double log_likelihood{};
};

Profile profile_at(const std::vector<Proportion>& participants, double mean) {
  const Minimum inside = minimum(
      [&](double eta) { return -log_likelihood(participants, mean, eta); }, 0.0, largest_eta);
  const double without = log_likelihood(participants, mean, 0.0);
  return without >= -inside.value - indistinguishable ? Profile{0.0, without}
                                                      : Profile{inside.at, -inside.value};
}

Interval profile_interval(const std::vector<Proportion>& participants, double mean,
                          double most_likely) {
  const double t = t_quantile(0.975, static_cast<double>(participants.size()) - 1.0);
  const auto excess = [&](double at) {
    return 2.0 * (most_likely - profile_at(participants, at).log_likelihood) - t * t;
  };
  constexpr double low = smallest_share;
  constexpr double high = 1.0 - smallest_share;
  const double from = std::clamp(mean, low, high);
  return {excess(low) <= 0.0 ? 0.0 : root(excess, low, from),
          excess(high) <= 0.0 ? 1.0 : root(excess, from, high)};
}

std::vector<Proportion> answered(const std::vector<Proportion>& participants) {
  std::vector<Proportion> found;
  for (const Proportion& of : participants) {
    if (of.successes < 0 || of.successes > of.trials) {
      throw core::InvalidInput{"right answers are between 0 and all answers"};
    }
    if (of.trials > 0) {
      found.push_back(of);
    }
  }
  return found;
}

// Of all answers, with its negative log likelihood.
Minimum pooled_share(const std::vector<Proportion>& people) {
  const Proportion all = sum(people);
  return {all.value(), -profile_at(people, all.value()).log_likelihood};
}

bool are_equal(const std::vector<double>& values) {
  return std::ranges::all_of(values, [&](double value) { return value == values.front(); });
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// Skewness of the jackknife values of the mean.
double acceleration(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double cubes = 0.0;
  double squares = 0.0;
  for (const double value : values) {
    const double difference = value - mean;  // that of jackknife means is in proportion
    cubes += difference * difference * difference;
    squares += difference * difference;
  }
  return cubes / (6.0 * std::pow(squares, 1.5));
}

void check_values(const std::vector<double>& values) {
  if (values.size() < 2 ||
      !std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) {
    throw core::InvalidInput{"an interval of a mean takes two finite values or more"};
  }
}

Interval within_shares(const Interval& interval) {
  return {std::max(0.0, interval.low), std::min(1.0, interval.high)};
}
}  // namespace

Interval t_interval(const std::vector<double>& values) {
  check_values(values);
  const MeanAndSpread spread = mean_and_spread(values);
  const auto n = static_cast<double>(values.size());
  const double reach = t_quantile(0.975, n - 1.0) * spread.standard_deviation / std::sqrt(n);
  return {spread.mean - reach, spread.mean + reach};
}

std::optional<Interval> bca_interval(const std::vector<double>& values, int draws,
                                     std::uint64_t seed, double tail) {
  check_values(values);
  if (are_equal(values)) {
    return std::nullopt;
  }
  const double observed = mean_of(values);
  std::vector<double> means = replicates(
      draws,
      [&](std::uint64_t own_seed) {
        core::Rng rng{own_seed};
        double sum = 0.0;
        for (std::size_t i = 0; i < values.size(); ++i) {
          sum += values[rng.below(static_cast<std::uint32_t>(values.size()))];
        }
        return sum / static_cast<double>(values.size());
      },
      seed);
  const double rounding = 1e-12 * std::max(1.0, std::abs(observed));
  double below = 0.0;
  for (const double mean : means) {
    below += mean < observed - rounding ? 1.0 : mean <= observed + rounding ? 0.5 : 0.0;
  }
  const double bias = normal_quantile(below / static_cast<double>(draws));
  const double a = acceleration(values);
  const auto level = [&](double z) {
    const double shrunk = 1.0 - a * (bias + z);
    return shrunk > 0.0 ? normal_cdf(bias + (bias + z) / shrunk) : z > 0.0 ? 1.0 : 0.0;
  };
  const double z = -normal_quantile(tail);
  return Interval{quantile(means, level(-z)), quantile(means, level(z))};
}

std::optional<Interval> bootstrap_interval(const std::vector<double>& values, int draws,
                                           std::uint64_t seed) {
  check_values(values);
  const auto n = static_cast<double>(values.size());
  const double expanded_tail = normal_cdf(-std::sqrt(n / (n - 1.0)) * t_quantile(0.975, n - 1.0));
  return bca_interval(values, draws, seed, expanded_tail);
}

std::optional<BetaBinomialMean> beta_binomial_mean(const std::vector<Proportion>& participants) {
  const std::vector<Proportion> people = answered(participants);
  if (people.size() < 2) {
    return std::nullopt;
  }
  Minimum best =
      minimum([&](double mean) { return -profile_at(people, mean).log_likelihood; }, 0.0, 1.0);
  // without correlation it is the share of all answers
  const Minimum pooled = pooled_share(people);
  best = pooled.value <= best.value + indistinguishable ? pooled : best;
  const double eta = profile_at(people, best.at).eta;
  BetaBinomialMean result{static_cast<int>(people.size()), best.at, eta * eta,
                          profile_interval(people, best.at, -best.value)};
  if (eta > 0.0 && eta < largest_eta && best.at > 0.0 && best.at < 1.0) {
    const auto [mean, nu] = refined(people, {best.at, 1.0 / (eta * eta) - 1.0});
    result.mean = mean;
    result.intraclass_correlation = 1.0 / (1.0 + nu);
  }
  return result;
}

std::optional<MeanProportion> mean_proportion(const std::vector<Proportion>& participants) {
  const auto model = beta_binomial_mean(participants);
  if (!model) {
    return std::nullopt;
  }
  std::vector<double> shares;
  std::ranges::transform(answered(participants), std::back_inserter(shares), &Proportion::value);
  MeanProportion result{*model, mean_of(shares), {}, {}};
  if (!are_equal(shares)) {
    result.t = within_shares(t_interval(shares));
    if (const auto bootstrap = bootstrap_interval(shares, bootstrap_draws, bootstrap_seed)) {
      result.bootstrap = within_shares(*bootstrap);
    }
  }
  return result;
}
}  // namespace tapstudy::analysis
