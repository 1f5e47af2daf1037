#pragma once
#include <vector>

namespace tapstudy::analysis {
// Ratings or ranks of the same k conditions by each of n participants: ratings[participant]
// [condition]. Functions throw InvalidInput unless there are two participants and two conditions
// or more, all participants have as many, and every rating is finite.
using RatingTable = std::vector<std::vector<double>>;

struct FriedmanTest {
  double chi_squared{};         // corrected for ties
  double degrees_of_freedom{};  // k - 1
  double p{};                   // by chi-squared
  double kendalls_w{};          // chi_squared / (n (k - 1)): 0 no agreement, 1 complete agreement
  std::vector<double> mean_ranks;  // of each condition; 1 is the lowest rating
};
// Friedman 1937; Kendall & Babington Smith 1939. With rank sums R_j and t tied ratings of one
// participant, chi_squared = 12 sum (R_j - n (k + 1) / 2)^2 / (n k (k + 1) - sum (t^3 - t) / (k -
// 1)). Throws InvalidInput also if every participant rates all conditions the same.
FriedmanTest friedman_test(const RatingTable& ratings);

void check_ratings(const RatingTable& ratings);
}  // namespace tapstudy::analysis
