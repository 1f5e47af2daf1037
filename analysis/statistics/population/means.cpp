#include "analysis/statistics/population/means.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/numerics.hpp"
#include "analysis/statistics/psychometric/likelihood.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "analysis/statistics/resampling/replicates.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
namespace tapstudy::analysis {
namespace {
struct Slopes {
  Eigen::Vector2d score{Eigen::Vector2d::Zero()};  // by a = nu mean and b = nu (1 - mean)
  Eigen::Matrix2d curvature{Eigen::Matrix2d::Zero()};
};

// Slopes of sum ln B(k + a, n - k + b) - ln B(a, b) along a and b.
Slopes slopes_at(const std::vector<Proportion>& people, double a, double b) {
  Slopes sum;
  for (const Proportion& of : people) {
    const auto k = static_cast<double>(of.successes);
    const auto n = static_cast<double>(of.trials);
    const double both = digamma(a + b) - digamma(n + a + b);
    sum.score +=
        Eigen::Vector2d{digamma(k + a) - digamma(a) + both, digamma(n - k + b) - digamma(b) + both};
    const double both_again = trigamma(a + b) - trigamma(n + a + b);
    sum.curvature.array() += both_again;
    sum.curvature(0, 0) += trigamma(k + a) - trigamma(a);
    sum.curvature(1, 1) += trigamma(n - k + b) - trigamma(b);
  }
  return sum;
}
}  // namespace

BetaBinomialParameters refined(const std::vector<Proportion>& people,
                               const BetaBinomialParameters& near) {
  constexpr int steps = 6;
  constexpr double farthest = 1e-2;  // of either, in proportion
  const Eigen::Array2d start{near.nu * near.mean, near.nu * (1.0 - near.mean)};
  Eigen::Array2d at = start;
  for (int i = 0; i < steps; ++i) {
    const Slopes slopes = slopes_at(people, at[0], at[1]);
    at -= slopes.curvature.fullPivLu().solve(slopes.score).array();
    if (!((at / start - 1.0).abs() < farthest).all()) {
      return near;
    }
  }
  return {at[0] / at.sum(), at.sum()};
}

namespace {
constexpr int bootstrap_draws = 4999;
constexpr std::uint64_t bootstrap_seed = 2;
constexpr double largest_eta = 0.999;       // square root of the intra-class correlation
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

std::vector<double> shares_of(const std::vector<Proportion>& people) {
  std::vector<double> shares;
  std::ranges::transform(people, std::back_inserter(shares), &Proportion::value);
  return shares;
}

// The share of right answers in all pooled, with its negative log likelihood.
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

Interval positive_interval(const std::vector<double>& values) {
  const Interval by_t = t_interval(values);
  if (std::ranges::any_of(values, [](double value) { return value < 0.0; })) {
    return by_t;
  }
  const double mean = 0.5 * (by_t.low + by_t.high);
  const double reach = by_t.high - mean;
  const double e = mean > 0.0 ? reach * reach / mean : 0.0;
  return {std::max(0.0, by_t.low), mean + 0.5 * e + std::sqrt(e * mean + 0.25 * e * e)};
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
  if (values.size() < fewest_to_draw_from) {
    return std::nullopt;
  }
  const auto n = static_cast<double>(values.size());
  const double expanded_tail = normal_cdf(-std::sqrt(n / (n - 1.0)) * t_quantile(0.975, n - 1.0));
  return bca_interval(values, draws, seed, expanded_tail);
}

namespace {
// The variance of participants' shares in proportion to mean (1 - mean).
double dispersion(const std::vector<Proportion>& people, const MeanAndSpread& of) {
  constexpr std::int64_t fewest = 2;  // answers of a kind, of which a variance says anything
  double binomial = 0.0;
  for (const Proportion& person : people) {
    binomial += 1.0 / static_cast<double>(person.trials) / static_cast<double>(people.size());
  }
  const Proportion all = sum(people);
  const bool are_few = std::min(all.successes, all.trials - all.successes) < fewest;
  const double least = (are_few ? 1.0 : share_of_binomial) * binomial;
  const double most = of.mean * (1.0 - of.mean);
  const double variance = of.standard_deviation * of.standard_deviation;
  return most > 0.0 ? std::max(least, variance / most) : least;
}

Interval score_interval(double mean, double dispersion, double n) {
  const double t = t_quantile(0.975, n - 1.0);
  const double e = t * t * dispersion / n;
  const double centre = (mean + 0.5 * e) / (1.0 + e);
  const double half = std::sqrt(e * mean * (1.0 - mean) + 0.25 * e * e) / (1.0 + e);
  // whole to the last digit where all answers are alike
  return {mean <= 0.0 ? 0.0 : std::max(0.0, centre - half),
          mean >= 1.0 ? 1.0 : std::min(1.0, centre + half)};
}

// How much the likelihood has to say of how people differ: nothing of means that are not near an
// end of the scale, somewhat more than the spread at the end.
double weight_of_likelihood(double mean) {
  constexpr double first = 0.5;  // of the way from 1/2 to the end
  return 0.6 * std::clamp((std::abs(2.0 * mean - 1.0) - first) / (1.0 - first), 0.0, 1.0);
}

// The variance of the mean of shares, in proportion to mean (1 - mean) / people, of the likeliest
// intra-class correlation of people with that mean.
double likeliest_dispersion(const std::vector<Proportion>& people, double mean) {
  const double eta = profile_at(people, mean).eta;
  double sum = 0.0;
  for (const Proportion& person : people) {
    const auto trials = static_cast<double>(person.trials);
    sum += (1.0 + (trials - 1.0) * eta * eta) / trials;
  }
  return sum / static_cast<double>(people.size());
}

// As score_interval, with what a mean so far from the one observed would say of how people differ.
Interval interval_near_end(const std::vector<Proportion>& people, double mean, double dispersion) {
  const auto n = static_cast<double>(people.size());
  const double weight = weight_of_likelihood(mean);
  const double t = t_quantile(0.975, n - 1.0);
  const double shown = t * t * dispersion;
  const double cut = n * std::log1p(t * t / (n - 1.0));
  const auto excess = [&](double other) {
    const double likeliest = cut * likeliest_dispersion(people, other);
    const double both = std::pow(shown, 1.0 - weight) * std::pow(likeliest, weight);
    return (mean - other) * (mean - other) - std::max(shown, both) * other * (1.0 - other) / n;
  };
  constexpr double least = 1e-9;
  constexpr double most = 1.0 - least;
  // whole to the last digit where all answers are alike, beside which excess is 0 at the end itself
  return {mean <= least ? 0.0 : root(excess, least, std::min(mean, most)),
          mean >= most ? 1.0 : root(excess, std::max(mean, least), most)};
}
}  // namespace

std::optional<MeanShare> mean_share(const std::vector<Proportion>& participants) {
  const std::vector<Proportion> people = answered(participants);
  if (people.size() < 2) {
    return std::nullopt;
  }
  const MeanAndSpread of = mean_and_spread(shares_of(people));
  MeanShare result{static_cast<int>(people.size()), of.mean, {}};
  if (people.size() > 2) {
    const double shown = dispersion(people, of);
    result.interval = weight_of_likelihood(of.mean) > 0.0
                          ? interval_near_end(people, of.mean, shown)
                          : score_interval(of.mean, shown, static_cast<double>(people.size()));
  }
  return result;
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
  if (eta > 0.0 && eta < largest_eta && best.at > 0.0 && best.at < 1.0) {
    const auto [mean, nu] = refined(people, {best.at, 1.0 / (eta * eta) - 1.0});
    return BetaBinomialMean{mean, 1.0 / (1.0 + nu)};
  }
  return BetaBinomialMean{best.at, eta * eta};
}

std::optional<MeanProportion> mean_proportion(const std::vector<Proportion>& participants) {
  const auto mean = mean_share(participants);
  if (!mean) {
    return std::nullopt;
  }
  const std::vector<double> shares = shares_of(answered(participants));
  MeanProportion result{*mean, beta_binomial_mean(participants)->intraclass_correlation, {}, {}};
  if (!are_equal(shares)) {
    result.t = within_shares(t_interval(shares));
    if (const auto bootstrap = bootstrap_interval(shares, bootstrap_draws, bootstrap_seed)) {
      result.bootstrap = within_shares(*bootstrap);
    }
  }
  return result;
}

namespace {
constexpr std::size_t most_enumerated = 16;
constexpr int sign_flips = 9999;

double exact_p(const std::vector<double>& sizes, double limit) {
  const std::size_t patterns = std::size_t{1} << sizes.size();
  std::size_t as_far = 0;
  for (std::size_t pattern = 0; pattern < patterns; ++pattern) {
    double sum = 0.0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      sum += ((pattern >> i) & 1U) != 0 ? sizes[i] : -sizes[i];
    }
    as_far += std::abs(sum) >= limit ? 1 : 0;
  }
  return static_cast<double>(as_far) / static_cast<double>(patterns);
}
}  // namespace

SignFlipTest sign_flip_test(const std::vector<double>& differences, std::uint64_t seed) {
  if (differences.empty() ||
      !std::ranges::all_of(differences, [](double value) { return std::isfinite(value); })) {
    throw core::InvalidInput{"a paired contrast takes one finite difference or more"};
  }
  std::vector<double> sizes;
  for (const double difference : differences) {
    if (difference != 0.0) {
      sizes.push_back(std::abs(difference));
    }
  }
  const double observed = std::abs(std::accumulate(differences.begin(), differences.end(), 0.0));
  const double all = std::accumulate(sizes.begin(), sizes.end(), 0.0);
  const double rounding = 1e-12 * all;
  if (sizes.size() <= most_enumerated) {
    return {exact_p(sizes, observed - rounding), true};
  }
  const auto sums = replicates(
      sign_flips,
      [&](std::uint64_t own_seed) {
        core::Rng rng{own_seed};
        double sum = 0.0;
        for (const double size : sizes) {
          sum += rng.below(2) == 0 ? size : -size;
        }
        return std::abs(sum);
      },
      seed);
  return {monte_carlo_p(sums, observed - rounding), false};
}

PairedContrast paired_contrast(const std::vector<double>& differences, std::uint64_t seed) {
  const SignFlipTest test = sign_flip_test(differences, seed);
  PairedContrast result;
  result.participants = static_cast<int>(differences.size());
  result.mean = std::accumulate(differences.begin(), differences.end(), 0.0) /
                static_cast<double>(differences.size());
  result.p = test.p;
  result.is_exact = test.is_exact;
  result.direction = result.mean;
  const bool are_equal =
      std::ranges::all_of(differences, [&](double value) { return value == differences.front(); });
  if (differences.size() > 1 && !are_equal) {
    result.interval = t_interval(differences);
  }
  return result;
}

namespace {
bool is_exact(const Interval& range) {
  return range.low == range.high;
}

class CensoredNormal {
 public:
  explicit CensoredNormal(const std::vector<Interval>& differences) : differences_{differences} {
    for (const Interval& range : differences) {
      for (const double end : {range.low, range.high}) {
        if (std::isfinite(end)) {
          low_ = std::min(low_, end);
          high_ = std::max(high_, end);
        }
      }
    }
  }
  double length() const { return std::max(high_ - low_, 1e-9); }
  double low() const { return low_; }
  double high() const { return high_; }

  // -l(mean), at the likeliest standard deviation.
  double profile(double mean) const {
    const double scale = std::log(length() + std::abs(mean - 0.5 * (low_ + high_)));
    constexpr double decades = 7.0;
    return minimum([&](double log_sd) { return negative(mean, std::exp(log_sd)); }, scale - decades,
                   scale + decades)
        .value;
  }

 private:
  double negative(double mean, double sd) const {
    double sum = 0.0;
    for (const Interval& range : differences_) {
      const double z = (range.low - mean) / sd;
      if (is_exact(range)) {
        sum += 0.5 * z * z + std::log(sd);
      } else {
        constexpr double least = 1e-300;
        const double upper = (range.high - mean) / sd;  // tails by the nearer end
        const double p =
            z > 0.0 ? normal_cdf(-z) - normal_cdf(-upper) : normal_cdf(upper) - normal_cdf(z);
        sum -= std::log(std::max(p, least));
      }
    }
    return sum;
  }

  const std::vector<Interval>& differences_;
  double low_{std::numeric_limits<double>::infinity()};
  double high_{-std::numeric_limits<double>::infinity()};
};

// The least that a difference can be in size.
double size_of(const Interval& range) {
  const bool may_be_none = range.low < 0.0 && range.high > 0.0;
  return may_be_none ? 0.0 : std::min(std::abs(range.low), std::abs(range.high));
}

// Ties share the mean of their ranks.
double rank_of(const Interval& range, const std::vector<Interval>& differences) {
  const double own = size_of(range);
  double rank = 0.5;
  for (const Interval& other : differences) {
    const double size = size_of(other);
    rank += size < own ? 1.0 : size == own ? 0.5 : 0.0;
  }
  return rank;
}

// Differences signed, as large as their ranks by size are.
std::vector<double> signed_ranks(const std::vector<Interval>& differences) {
  std::vector<double> ranks;
  for (const Interval& range : differences) {
    const bool has_side = !is_exact(range) && (range.low >= 0.0 || range.high <= 0.0);
    const double rank = size_of(range) == 0.0 && !has_side ? 0.0 : rank_of(range, differences);
    ranks.push_back(range.low >= 0.0 ? rank : -rank);
  }
  return ranks;
}
}  // namespace

CensoredMean censored_mean(const std::vector<Interval>& differences, double confidence,
                           const std::vector<double>& values) {
  if (differences.empty()) {
    throw core::InvalidInput{"there are no differences"};
  }
  if (std::ranges::count_if(differences, is_exact) < 2) {
    throw core::NotEstimable{"fewer than two values are known, but for being beyond the levels"};
  }
  const CensoredNormal likelihood{differences};
  const double reach = 20.0 * likelihood.length();
  const auto profile = [&](double mean) { return likelihood.profile(mean); };
  const Minimum best = minimum(profile, likelihood.low() - reach, likelihood.high() + reach);
  const auto n = static_cast<double>(differences.size());
  const double quantile = t_quantile(0.5 * (1.0 + confidence), n - 1.0);
  const double limit = n * std::log1p(quantile * quantile / (n - 1.0));
  const auto excess = [&](double mean) { return 2.0 * (profile(mean) - best.value) - limit; };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double low = best.at - 10.0 * reach;
  const double high = best.at + 10.0 * reach;
  CensoredMean found{best.at,
                     {excess(low) <= 0.0 ? -infinity : root(excess, low, best.at),
                      excess(high) <= 0.0 ? infinity : root(excess, best.at, high)},
                     {}};
  for (const double value : values) {
    const double deviance = std::max(0.0, 2.0 * (profile(value) - best.value));
    found.t.push_back(
        std::copysign(std::sqrt((n - 1.0) * std::expm1(deviance / n)), best.at - value));
  }
  return found;
}

PairedContrast censored_contrast(const std::vector<Interval>& differences, std::uint64_t seed) {
  const std::vector<double> ranks = signed_ranks(differences);
  const SignFlipTest test = sign_flip_test(ranks, seed);
  const auto exact = static_cast<int>(std::ranges::count_if(differences, is_exact));
  const auto participants = static_cast<int>(differences.size());
  PairedContrast result{std::nan(""),
                        {},
                        test.p,
                        participants,
                        test.is_exact,
                        std::accumulate(ranks.begin(), ranks.end(), 0.0),
                        participants - exact};
  if (exact > 1) {
    constexpr double confidence = 0.95;
    const CensoredMean found = censored_mean(differences, confidence);
    result.mean = found.mean;
    result.interval = found.interval;
  }
  return result;
}

std::optional<Interval> bounded_interval(const std::vector<double>& values,
                                         const Interval& bounds) {
  check_values(values);
  const double length = bounds.high - bounds.low;
  std::vector<double> shares;
  for (const double value : values) {
    if (!(value >= bounds.low && value <= bounds.high)) {
      throw core::InvalidInput{"values lie within the bounds of their scale"};
    }
    shares.push_back((value - bounds.low) / length);
  }
  if (are_equal(values)) {
    return std::nullopt;
  }
  const MeanAndSpread of = mean_and_spread(shares);
  const double variance = of.standard_deviation * of.standard_deviation;
  const Interval score = score_interval(of.mean, variance / (of.mean * (1.0 - of.mean)),
                                        static_cast<double>(values.size()));
  return Interval{bounds.low + length * score.low, bounds.low + length * score.high};
}
}  // namespace tapstudy::analysis
