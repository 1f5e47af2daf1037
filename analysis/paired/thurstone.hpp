#pragma once
#include "analysis/paired/paired_counts.hpp"
#include "analysis/paired/preference_scale.hpp"
namespace tapstudy::analysis {
// Thurstone 1927, Case V, by maximum likelihood: P(i preferred to j) = Phi(v_i - v_j). The unit is
// the standard deviation of a difference of two impressions, sqrt 2 of that of one. A tie counts as
// half a preference in each direction. Throws InvalidInput as check_comparisons does (ties
// connect).
PreferenceScale thurstone_case_v(const PairedCounts& counts);
}  // namespace tapstudy::analysis
