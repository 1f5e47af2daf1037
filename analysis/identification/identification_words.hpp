#pragma once
#include <string>

#include "analysis/identification/identification_summary.hpp"
namespace tapstudy::analysis {
// "material, given structure is right"
std::string title_of(const FactorResult& result);
// "43/80 = 54 % (95 % CI over 10 participants 46–62 %)", or where there are not two participants
// "43/80 = 54 % (43–64 % if answers are independent)".
std::string with_interval(const Proportion& pooled, const std::optional<MeanProportion>& over);
}  // namespace tapstudy::analysis
