#include "analysis/statistics/population/independent_groups.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "analysis/statistics/resampling/replicates.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double most_assignments = 20'000.0;
constexpr int random_assignments = 9999;

struct Moments {
  double mean{};
  double variance_of_mean{};
  double freedom{};
};

Moments moments_of(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  const auto [mean, standard_deviation] = mean_and_spread(values);
  return {mean, standard_deviation * standard_deviation / n, n - 1.0};
}

// t^2 / (t^2 + 1), which grows with Welch's |t| and is finite where values do not differ.
double statistic(std::span<const double> values, std::size_t first, double rounding) {
  const Moments one = moments_of(values.first(first));
  const Moments other = moments_of(values.subspan(first));
  const double squared = (one.mean - other.mean) * (one.mean - other.mean);
  if (squared <= rounding) {
    return 0.0;
  }
  return squared / (squared + one.variance_of_mean + other.variance_of_mean);
}

double number_of_assignments(std::size_t all, std::size_t first) {
  double number = 1.0;
  for (std::size_t i = 1; i <= first; ++i) {
    number *= static_cast<double>(all - first + i) / static_cast<double>(i);
  }
  return number;
}

// Each assignment once: who is in the first group is a word of as many ones.
double p_of_all_assignments(const std::vector<double>& values, std::size_t first, double observed,
                            double rounding) {
  std::vector<char> is_second(values.size(), 1);
  std::fill_n(is_second.begin(), first, static_cast<char>(0));
  double all = 0.0;
  double as_large = 0.0;
  std::vector<double> assigned(values.size());
  do {
    std::size_t one = 0;
    std::size_t other = first;
    for (std::size_t i = 0; i < values.size(); ++i) {
      assigned[is_second[i] != 0 ? other++ : one++] = values[i];
    }
    all += 1.0;
    as_large += statistic(assigned, first, rounding) >= observed - 1e-9 ? 1.0 : 0.0;
  } while (std::next_permutation(is_second.begin(), is_second.end()));
  return as_large / all;
}

void check_group(const std::vector<double>& values) {
  if (values.size() < 2 ||
      !std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) {
    throw core::InvalidInput{"a contrast of groups takes two finite values or more of each"};
  }
}
}  // namespace

PermutationTest group_permutation_test(const std::vector<double>& first,
                                       const std::vector<double>& second, std::uint64_t seed) {
  check_group(first);
  check_group(second);
  std::vector<double> all = first;
  all.insert(all.end(), second.begin(), second.end());
  double largest = 0.0;
  for (const double value : all) {
    largest = std::max(largest, std::abs(value));
  }
  const double rounding = 1e-24 * largest * largest;
  const double observed = statistic(all, first.size(), rounding);
  if (number_of_assignments(all.size(), first.size()) <= most_assignments) {
    return {p_of_all_assignments(all, first.size(), observed, rounding), true};
  }
  const auto drawn = replicates(
      random_assignments,
      [&](std::uint64_t own_seed) {
        core::Rng rng{own_seed};
        std::vector<double> assigned = all;
        rng.shuffle(assigned);
        return statistic(assigned, first.size(), rounding);
      },
      seed);
  return {monte_carlo_p(drawn, observed), false};
}

GroupContrast group_contrast(const std::vector<double>& first, const std::vector<double>& second,
                             std::uint64_t seed) {
  GroupContrast contrast;
  contrast.test = group_permutation_test(first, second, seed);
  const Moments one = moments_of(first);
  const Moments other = moments_of(second);
  contrast.difference = one.mean - other.mean;
  const double variance = one.variance_of_mean + other.variance_of_mean;
  if (variance > 0.0) {
    const double freedom = variance * variance /
                           (one.variance_of_mean * one.variance_of_mean / one.freedom +
                            other.variance_of_mean * other.variance_of_mean / other.freedom);
    const double half = t_quantile(0.975, freedom) * std::sqrt(variance);
    contrast.interval = Interval{contrast.difference - half, contrast.difference + half};
  }
  return contrast;
}

GroupScores gehan_scores(const std::vector<Interval>& first, const std::vector<Interval>& second) {
  std::vector<Interval> all = first;
  all.insert(all.end(), second.begin(), second.end());
  const auto is_below = [](const Interval& one, const Interval& other) {
    return one.high <= other.low && one.low < other.high;
  };
  const auto scores = [&](const std::vector<Interval>& group) {
    std::vector<double> found;
    for (const Interval& own : group) {
      double score = 0.0;
      for (const Interval& other : all) {
        score += is_below(other, own) ? 1.0 : is_below(own, other) ? -1.0 : 0.0;
      }
      found.push_back(score);
    }
    return found;
  };
  return {scores(first), scores(second)};
}
}  // namespace tapstudy::analysis
