#pragma once
#include <vector>
namespace tapstudy::analysis {
// The ranks of values, from 1; equal values share the mean of their ranks.
std::vector<double> mid_ranks(const std::vector<double>& values);
// Sum over groups of equal values of t^3 - t, for the correction of ties.
double tie_sum(const std::vector<double>& values);
}  // namespace tapstudy::analysis
