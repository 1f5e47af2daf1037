#include "analysis/participants/paired_contrast.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/participants/mean_proportion.hpp"
#include "analysis/resampling/replicates.hpp"
#include "core/error.hpp"
#include "core/rng.hpp"
namespace tapstudy::analysis {
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
  const bool are_equal =
      std::ranges::all_of(differences, [&](double value) { return value == differences.front(); });
  if (differences.size() > 1 && !are_equal) {
    result.interval = t_interval(differences);
  }
  return result;
}
}  // namespace tapstudy::analysis
