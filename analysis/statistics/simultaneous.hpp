#pragma once
#include <vector>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// 95 % intervals of the probabilities of all classes at once (Goodman 1965): with A the 1 - .05 / k
// quantile of chi-squared of one degree of freedom, (A + 2 n_i -+ sqrt(A (A + 4 n_i (N - n_i) /
// N))) / (2 (N + A)). counts of independent choices. Throws InvalidInput for fewer than two
// classes, counts below 0, and no counts above 0.
std::vector<Interval> simultaneous_intervals(const std::vector<int>& counts);
}  // namespace tapstudy::analysis
