#pragma once
#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
struct IntervalEstimate {
  double value{};
  Interval interval;  // at any level, the same for all that are compared
};
// Of b - a, for estimates of independent samples, at the level of their own intervals: the variance
// is recovered from how far these reach on the side that matters (MOVER; Zou & Donner 2008). For
// score intervals of proportions it is Newcombe's (1998) method 10.
IntervalEstimate independent_difference(const IntervalEstimate& a, const IntervalEstimate& b);
// Of b / a, both above 0: that of their logarithms.
IntervalEstimate independent_ratio(const IntervalEstimate& a, const IntervalEstimate& b);
}  // namespace tapstudy::analysis
