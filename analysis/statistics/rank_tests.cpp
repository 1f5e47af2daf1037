#include "analysis/statistics/rank_tests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/statistics/distributions.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
SignTest sign_test(const std::vector<double>& differences) {
  SignTest test;
  for (const double difference : differences) {
    test.above.trials += difference != 0.0 ? 1 : 0;
    test.above.successes += difference > 0.0 ? 1 : 0;
  }
  test.p = test.above.trials == 0 ? 1.0 : binomial_p_at_least(test.above, 0.5);
  return test;
}

std::vector<double> mid_ranks(const std::vector<double>& values) {
  std::vector<double> sorted = values;
  std::ranges::sort(sorted);
  std::vector<double> ranks;
  for (const double value : values) {
    const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), value);
    const auto below = static_cast<double>(first - sorted.begin());
    ranks.push_back(below + 0.5 * (static_cast<double>(last - first) + 1.0));
  }
  return ranks;
}

double tie_sum(const std::vector<double>& values) {
  std::vector<double> sorted = values;
  std::ranges::sort(sorted);
  double sum = 0.0;
  for (auto first = sorted.begin(); first != sorted.end();) {
    const auto last = std::upper_bound(first, sorted.end(), *first);
    const auto t = static_cast<double>(last - first);
    sum += t * t * t - t;
    first = last;
  }
  return sum;
}

void check_ratings(const RatingTable& ratings) {
  if (ratings.size() < 2 || ratings.front().size() < 2) {
    throw core::NotEstimable{"ratings are of two conditions or more by two participants or more"};
  }
  for (const std::vector<double>& row : ratings) {
    if (row.size() != ratings.front().size() ||
        !std::ranges::all_of(row, [](double rating) { return std::isfinite(rating); })) {
      throw core::InvalidInput{
          fmt::format("each participant has a finite rating of each of the {} conditions",
                      ratings.front().size())};
    }
  }
}

namespace {
// The distribution of V under all signs, given the ranks, which are whole when doubled.
double exact_p(const std::vector<double>& ranks, double v) {
  std::vector<std::size_t> doubled;
  std::size_t most = 0;
  for (const double rank : ranks) {
    doubled.push_back(static_cast<std::size_t>(std::llround(2.0 * rank)));
    most += doubled.back();
  }
  std::vector<double> p(most + 1, 0.0);
  p[0] = 1.0;
  for (const std::size_t rank : doubled) {
    for (std::size_t sum = most + 1; sum-- > 0;) {
      p[sum] = 0.5 * (p[sum] + (sum >= rank ? p[sum - rank] : 0.0));
    }
  }
  const auto observed = static_cast<std::size_t>(std::llround(2.0 * v));
  const auto tail = static_cast<std::ptrdiff_t>(std::min(observed, most - observed));
  return std::min(1.0, 2.0 * std::accumulate(p.begin(), p.begin() + tail + 1, 0.0));
}

double normal_p(int n, double v, double ties) {
  const double excess = v - 0.25 * n * (n + 1);
  const double variance = n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - ties / 48.0;
  const double correction = excess == 0.0 ? 0.0 : std::copysign(0.5, excess);
  return std::min(1.0, normal_two_sided_p((excess - correction) / std::sqrt(variance)));
}
}  // namespace

namespace {
void check_finite(const std::vector<double>& differences) {
  for (const double one : differences) {
    if (!std::isfinite(one)) {
      throw core::InvalidInput{fmt::format("a difference is a finite number, not {}", one)};
    }
  }
}

// Sizes that are equal but for rounding, as 0.3 - 0.1 and 0.7 - 0.5 are, become equal, or 0.
std::vector<double> sizes_without_rounding(const std::vector<double>& differences) {
  constexpr double rounding = 1e-9;
  std::vector<double*> ascending;
  std::vector<double> sizes = differences;
  for (double& size : sizes) {
    size = std::abs(size);
    ascending.push_back(&size);
  }
  std::ranges::sort(ascending, {}, [](const double* size) { return *size; });
  const double tolerance = rounding * *ascending.back();
  double level = 0.0;
  for (double* const size : ascending) {
    level = *size - level <= tolerance ? level : *size;
    *size = level;
  }
  return sizes;
}
}  // namespace

SignedRankTest signed_rank_test(const std::vector<double>& differences) {
  if (differences.empty()) {
    throw core::NotEstimable{"a signed rank test takes one difference or more"};
  }
  check_finite(differences);
  const std::vector<double> all_sizes = sizes_without_rounding(differences);
  std::vector<double> sizes;
  std::vector<bool> is_positive;
  for (std::size_t i = 0; i < differences.size(); ++i) {
    if (all_sizes[i] > 0.0) {
      sizes.push_back(all_sizes[i]);
      is_positive.push_back(differences[i] > 0.0);
    }
  }
  SignedRankTest test;
  test.pairs = static_cast<int>(sizes.size());
  const std::vector<double> ranks = mid_ranks(sizes);
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    test.positive_ranks += is_positive[i] ? ranks[i] : 0.0;
  }
  constexpr int fewest_for_normal = 50;
  test.is_exact = test.pairs < fewest_for_normal;
  if (test.pairs > 0) {
    test.p = test.is_exact ? exact_p(ranks, test.positive_ranks)
                           : normal_p(test.pairs, test.positive_ranks, tie_sum(sizes));
  }
  return test;
}

std::vector<double> holm_adjusted(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return p[i]; });
  std::vector<double> adjusted(p.size());
  double greatest = 0.0;
  for (std::size_t place = 0; place < order.size(); ++place) {
    const double one = p[order[place]];
    if (!(one >= 0.0 && one <= 1.0)) {
      throw core::InvalidInput{fmt::format("a p value is between 0 and 1, not {}", one)};
    }
    greatest = std::max(greatest, std::min(1.0, static_cast<double>(p.size() - place) * one));
    adjusted[order[place]] = greatest;
  }
  return adjusted;
}

std::vector<PairwiseTest> pairwise_signed_rank(const RatingTable& ratings) {
  check_ratings(ratings);
  std::vector<PairwiseTest> tests;
  std::vector<double> p;
  for (std::size_t i = 0; i < ratings.front().size(); ++i) {
    for (std::size_t j = i + 1; j < ratings.front().size(); ++j) {
      std::vector<double> differences;
      for (const std::vector<double>& row : ratings) {
        differences.push_back(row[i] - row[j]);
      }
      tests.push_back({i, j, signed_rank_test(differences), {}});
      if (tests.back().test.p) {
        p.push_back(*tests.back().test.p);
      }
    }
  }
  auto adjusted = holm_adjusted(p);
  auto next = adjusted.begin();
  for (PairwiseTest& test : tests) {
    if (test.test.p) {
      test.adjusted_p = *next++;
    }
  }
  return tests;
}
}  // namespace tapstudy::analysis
