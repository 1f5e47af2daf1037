#pragma once
#include <vector>

#include "analysis/statistics/proportion.hpp"
#include "analysis/tables/cells.hpp"
namespace tapstudy::analysis {
// What all participants answered, for a proportion_column: the counts together, with an interval
// over participants (beta_binomial_mean), because the answers of one are not independent of one
// another. Of a single participant the score interval; without one where it takes more participants
// with answers.
Cell pooled_proportion(const std::vector<Proportion>& participants);
}  // namespace tapstudy::analysis
