#include "analysis/statistics/simultaneous.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/statistics/distributions.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
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
}  // namespace tapstudy::analysis
