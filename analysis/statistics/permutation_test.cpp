#include "analysis/statistics/permutation_test.hpp"

#include <algorithm>

#include "analysis/resampling/replicates.hpp"
namespace tapstudy::analysis {
namespace {
std::vector<double> right_in(const CountTable& counts, const std::vector<RightAnswers>& notions) {
  std::vector<double> right(notions.size(), 0.0);
  for (std::size_t notion = 0; notion < notions.size(); ++notion) {
    for (std::size_t i = 0; i < counts.size(); ++i) {
      for (std::size_t j = 0; j < counts[i].size(); ++j) {
        right[notion] += notions[notion].at(i).at(j) ? static_cast<double>(counts[i][j]) : 0.0;
      }
    }
  }
  return right;
}
}  // namespace

std::vector<PermutationResult> permutation_tests(const NullTables& tables,
                                                 const std::vector<RightAnswers>& notions,
                                                 int draws, std::uint64_t seed) {
  const std::vector<double> observed = right_in(tables.observed, notions);
  const auto drawn = replicated_vectors(
      draws, [&](std::uint64_t own_seed) { return right_in(tables.draw(own_seed), notions); },
      seed);
  std::vector<PermutationResult> results;
  for (std::size_t notion = 0; notion < notions.size(); ++notion) {
    const auto as_good = std::ranges::count_if(
        drawn, [&](const std::vector<double>& right) { return right[notion] >= observed[notion]; });
    results.push_back({(1.0 + static_cast<double>(as_good)) / (static_cast<double>(draws) + 1.0),
                       static_cast<int>(as_good), draws});
  }
  return results;
}
}  // namespace tapstudy::analysis
