#pragma once
#include <string>

#include "analysis/blocks/block_summary.hpp"
#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// Number formatting common to all reports.
std::string fraction(const Proportion& proportion);       // "43/80"
std::string percent(const Proportion& proportion);        // "54 %", or "–" without trials
std::string percent(double share);                        // likewise
std::string with_interval(const Proportion& proportion);  // "43/80 = 54 % (95 % CI 43–64 %)"
std::string fraction_and_percent(const Proportion& proportion);  // "43/80 = 54 %"
// "43–64 %", with as many digits as its ends take to differ
std::string percent_range(const Interval& shares);
std::string p_value(double p);  // "p = .020", "p < .001"
// The same, "p ≤ 1/10000" where only a bound is known, or "not tested".
std::string p_value(const HypothesisResult& result);
}  // namespace tapstudy::analysis
