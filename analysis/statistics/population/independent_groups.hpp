#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
struct PermutationTest {
  double p{};       // two-sided
  bool is_exact{};  // of all assignments
};
// The permutation test of two groups of different people: if groups do not matter, each person
// might as well have been in the other one. The statistic is Welch's t, whose test also holds for
// the means of many people whose groups differ in spread (Janssen 1997). p is the share of
// assignments with a statistic at least as large: of all, where there are at most 20000, else
// monte_carlo_p of 9999 random ones. Throws InvalidInput for fewer than two values in a group and
// values that are not finite.
PermutationTest group_permutation_test(const std::vector<double>& first,
                                       const std::vector<double>& second, std::uint64_t seed);

// The means of two groups, first less second, with Welch's interval (1947) of 95 %; unset where the
// values of neither group differ. Throws as the test.
struct GroupContrast {
  double difference{};
  std::optional<Interval> interval;
  PermutationTest test;
};
GroupContrast group_contrast(const std::vector<double>& first, const std::vector<double>& second,
                             std::uint64_t seed);

// Values of two groups of which some are only known to lie in a range, by how many of all certainly
// lie below each less how many certainly lie above (Gehan 1965): the test of these scores takes
// nobody out, and is that of ranks where all values are known.
struct GroupScores {
  std::vector<double> first;
  std::vector<double> second;
};
GroupScores gehan_scores(const std::vector<Interval>& first, const std::vector<Interval>& second);
}  // namespace tapstudy::analysis
