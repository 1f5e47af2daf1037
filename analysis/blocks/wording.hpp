#pragma once
#include <string>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// How numbers are said, the same in every report.
std::string fraction(const Proportion& proportion);       // "43/80"
std::string percent(const Proportion& proportion);        // "54 %", or "–" of nothing
std::string with_interval(const Proportion& proportion);  // "43/80 = 54 % (95 % CI 43–64 %)"
std::string p_value(double p);                            // "p = .020", "p < .001"
}  // namespace tapstudy::analysis
