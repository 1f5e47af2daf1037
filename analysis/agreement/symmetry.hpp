#pragma once
#include <optional>

#include "analysis/statistics/count_table.hpp"
namespace tapstudy::analysis {
// A statistic with its chi-squared probability; all answers count as independent.
struct ChiSquaredTest {
  double chi_squared{};
  double degrees_of_freedom{};
  double p{};
};
// Bowker 1948: is i answered with j as often as j with i? Sum over pairs of (n_ij - n_ji)^2 /
// (n_ij + n_ji); one degree of freedom for each pair that was confused at all. Unset if none was.
// Both functions throw InvalidInput as totals_of_square does.
std::optional<ChiSquaredTest> bowker_test(const CountTable& table);

// Stuart 1955 and Maxwell 1970: is every class answered as often as it was presented? d' V^-1 d
// with d_i = n_i. - n_.i and V_ii = n_i. + n_.i - 2 n_ii, V_ij = -(n_ij + n_ji), without one class;
// as many degrees of freedom as the rank of V. Unset if that is 0.
std::optional<ChiSquaredTest> stuart_maxwell_test(const CountTable& table);
}  // namespace tapstudy::analysis
