#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// The exact sign test of "above 0 more often than below": differences of 0 are left out, the others
// are above 0 with a probability of 1/2 (Dixon & Mood 1946).
struct SignTest {
  Proportion above;  // of differences that are not 0
  double p{};        // one-sided; 1 if none is left
};
SignTest sign_test(const std::vector<double>& differences);

// The ranks of values, from 1; equal values share the mean of their ranks.
std::vector<double> mid_ranks(const std::vector<double>& values);
// Sum over groups of equal values of t^3 - t, for the correction of ties.
double tie_sum(const std::vector<double>& values);

// Ratings or ranks of the same k conditions by each of n participants: ratings[participant]
// [condition]. Functions throw InvalidInput unless there are two participants and two conditions
// or more, all participants have as many, and every rating is finite.
using RatingTable = std::vector<std::vector<double>>;

void check_ratings(const RatingTable& ratings);

struct SignedRankTest {
  double positive_ranks{};  // V: the sum of the ranks of differences above 0
  std::optional<double> p;  // two-sided; unset if no difference is left
  int pairs{};              // whose difference is not 0
  bool is_exact{};
};
// Wilcoxon 1945 on differences; those of 0 are left out, and those that are equal to nine digits of
// the largest are ties. For fewer than 50 others exact, given the
// mid-ranks of ties; else by the normal distribution with correction for ties and continuity.
// Throws InvalidInput for no or not finite differences.
SignedRankTest signed_rank_test(const std::vector<double>& differences);

// p values adjusted for their number by Holm 1979, in the order given. Each in [0, 1], else throws
// InvalidInput.
std::vector<double> holm_adjusted(const std::vector<double>& p);

struct PairwiseTest {
  std::size_t first{};  // conditions; differences are first - second
  std::size_t second{};
  SignedRankTest test;
  std::optional<double> adjusted_p;  // Holm over all pairs that are tested
};
// Every pair of conditions. Throws InvalidInput as check_ratings does.
std::vector<PairwiseTest> pairwise_signed_rank(const RatingTable& ratings);
}  // namespace tapstudy::analysis
