#pragma once
#include <vector>

#include "analysis/resampling/null_tables.hpp"
namespace tapstudy::analysis {
struct PermutationResult {
  double p{};     // (1 + draws at least as accurate) / (draws + 1) (Hope 1968)
  int as_good{};  // draws at least as accurate; if none, p is only known to be no larger
  int draws{};
};

// is_right[stimulus][response].
using RightAnswers = std::vector<std::vector<bool>>;

// Randomisation tests of accuracy against chance, for several notions of right at once, on the same
// draws. They make no assumption of independence between participants. The same seed gives the same
// p, on any number of threads.
std::vector<PermutationResult> permutation_tests(const NullTables& tables,
                                                 const std::vector<RightAnswers>& notions,
                                                 int draws, std::uint64_t seed);
}  // namespace tapstudy::analysis
