#include "analysis/statistics/sison_glaz.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/log_factorial.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
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

// Of a Poisson variable of this mean, given that it lies from low to high.
struct Truncated {
  double mean{};
  double second{};  // central moments
  double third{};
  double fourth{};
  double within{};  // the probability that it does
};

// From factorial moments mean^r P(low - r <= X <= high - r) / P(low <= X <= high).
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
}  // namespace tapstudy::analysis
