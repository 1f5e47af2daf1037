#pragma once
#include <string>
#include <vector>

#include "analysis/participants/mean_proportion.hpp"
#include "analysis/statistics/proportion.hpp"
#include "analysis/tables/cells.hpp"
namespace tapstudy::analysis {
// "(95 % CI over 4 participants 14–92 %)", of beta_binomial_mean; where its mean is not the share
// of all answers together, "(61 % estimated over 4 participants, 95 % CI 14–92 %)".
std::string over_participants(const Proportion& all, const BetaBinomialMean& over);

// What all participants answered, for a proportion_column: the counts together, with an interval
// over participants (beta_binomial_mean), because the answers of one are not independent of one
// another. Of a single participant the score interval; without one where it takes more participants
// with answers.
Cell pooled_proportion(const std::vector<Proportion>& participants);
}  // namespace tapstudy::analysis
