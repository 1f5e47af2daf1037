#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "analysis/rank_tests/friedman.hpp"
namespace tapstudy::analysis {
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
