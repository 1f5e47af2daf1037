#include "analysis/rank_tests/friedman.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/rank_tests/ranks.hpp"
#include "analysis/statistics/distributions.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
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
std::vector<double> mean_ranks_of(const RatingTable& ratings) {
  std::vector<double> means(ratings.front().size(), 0.0);
  for (const std::vector<double>& row : ratings) {
    const std::vector<double> ranks = mid_ranks(row);
    for (std::size_t j = 0; j < means.size(); ++j) {
      means[j] += ranks[j] / static_cast<double>(ratings.size());
    }
  }
  return means;
}
}  // namespace

FriedmanTest friedman_test(const RatingTable& ratings) {
  check_ratings(ratings);
  FriedmanTest test;
  test.mean_ranks = mean_ranks_of(ratings);
  const auto n = static_cast<double>(ratings.size());
  const auto k = static_cast<double>(test.mean_ranks.size());
  double squares = 0.0;
  for (const double mean_rank : test.mean_ranks) {
    squares += n * n * (mean_rank - 0.5 * (k + 1.0)) * (mean_rank - 0.5 * (k + 1.0));
  }
  double ties = 0.0;
  for (const std::vector<double>& row : ratings) {
    ties += tie_sum(row);
  }
  const double spread = n * k * (k + 1.0) - ties / (k - 1.0);
  if (!(spread > 1e-9)) {
    throw core::NotEstimable{"every participant rates all conditions the same: nothing to test"};
  }
  test.chi_squared = 12.0 * squares / spread;
  test.degrees_of_freedom = k - 1.0;
  test.p = chi_squared_p(test.chi_squared, test.degrees_of_freedom);
  test.kendalls_w = test.chi_squared / (n * (k - 1.0));
  return test;
}

}  // namespace tapstudy::analysis
