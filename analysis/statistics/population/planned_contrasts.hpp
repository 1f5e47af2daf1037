#pragma once
#include <cstdint>
#include <vector>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// Two one-sided t tests (TOST) of the mean of paired differences: that it lies above -bound, and
// below it. p, of the hypothesis that it lies between, is the larger of the two; it is below .05
// just where the 90 % interval by t lies within the bounds. Throws InvalidInput for fewer than two
// finite differences and a bound that is not above 0, NotEstimable where all differences are equal.
struct EquivalenceTest {
  double mean{};
  Interval interval_90;
  double p_above{};  // of the hypothesis that the mean lies above -bound
  double p_below{};
  double p{};
};
EquivalenceTest equivalence_test(const std::vector<double>& differences, double bound);
// The same of differences of which some are only known to lie in a range: by their normal
// likelihood (censored_mean), which of exact ones is t. Throws NotEstimable as that, too.
EquivalenceTest equivalence_test(const std::vector<Interval>& differences, double bound);

// Whether the effects of two factors depend on one another. values[person] has a row a level of the
// first factor and a column a level of the second. The statistic is F of the interaction of
// repeated measures; p is the share of patterns of signs of participants' own interactions (what is
// left of their values without the means of rows and columns) with an F at least as large: of all
// patterns for up to 16 participants, else monte_carlo_p of 9999. It is valid where an interaction
// of any participant is as probable as its opposite, however participants differ. For two levels
// each it is the test of differences of differences by signs (sign_flip_test). Throws InvalidInput
// for tables of different or too few levels and fewer than two participants, NotEstimable where
// nobody's values have an interaction.
using LevelTable = std::vector<std::vector<double>>;
struct InteractionTest {
  double f{};  // infinite where all participants have the same interaction
  double numerator_freedom{};
  double denominator_freedom{};
  double p{};
  bool is_exact{};
};
InteractionTest interaction_test(const std::vector<LevelTable>& values, std::uint64_t seed);
}  // namespace tapstudy::analysis
