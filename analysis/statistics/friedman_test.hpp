#pragma once
#include <cstdint>
#include <vector>

#include "analysis/statistics/rank_tests.hpp"
namespace tapstudy::analysis {
struct FriedmanTest {
  double chi_squared{};         // corrected for ties
  double degrees_of_freedom{};  // k - 1
  double p{};                   // by permutations
  bool is_exact{};              // p is of all permutations
  double kendalls_w{};          // chi_squared / (n (k - 1)): 0 no agreement, 1 complete agreement
  std::vector<double> mean_ranks;  // of each condition; 1 is the lowest rating
};
// Friedman 1937; Kendall & Babington Smith 1939. With rank sums R_j and t tied ratings of one
// participant, chi_squared = 12 sum (R_j - n (k + 1) / 2)^2 / (n k (k + 1) - sum (t^3 - t) / (k -
// 1)). If conditions do not matter, each participant's ranks might as well stand in any other
// order: p is the share of these orders with a chi_squared at least as large. It is of all orders
// where they can be counted, else monte_carlo_p of 9999 random ones. The distribution of
// chi-squared, which it is named after, would reject too seldom for few participants. Throws
// InvalidInput also if every participant rates all conditions the same.
FriedmanTest friedman_test(const RatingTable& ratings, std::uint64_t seed);
}  // namespace tapstudy::analysis
