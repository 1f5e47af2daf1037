#pragma once
#include <string>

#include "analysis/summary.hpp"
namespace tapstudy::analysis {
// How numbers are said, the same in every report.
std::string fraction(const Proportion& proportion);           // "43/80"
std::string percent(const Proportion& proportion);            // "54 %", or "–" of nothing
std::string with_interval(const Proportion& proportion);      // "43/80 = 54 % (95 % CI 43–64 %)"
std::string p_value(double p);                                // "p = .020", "p < .001"
std::string multinomial_words(const ChoiceSummary& summary);  // the p value, or why there is none
std::string title_of(const FactorResult& result);  // "material, given structure is right"
bool is_simulated(const Summary& summary);
// A paragraph on how the numbers were made, for a methods section.
std::string methods(const Summary& summary);
}  // namespace tapstudy::analysis
