#pragma once
#include <optional>
#include <string>
#include <vector>

#include "analysis/blocks/block_summary.hpp"
#include "analysis/rank_tests/friedman.hpp"
#include "analysis/rank_tests/signed_rank.hpp"
#include "analysis/statistics/quantiles.hpp"
namespace tapstudy::analysis {
// Ratings from 1 to design.steps, or on a line from 0 to 1, of one presented stimulus a trial.
struct StimulusRatings {
  std::string stimulus;
  std::vector<int> counts;             // of each step, from 1; empty of a line
  std::optional<Quartiles> quartiles;  // of all ratings; unset if there are none
};

struct RatingResults {
  std::vector<StimulusRatings> stimuli;   // in the order of the block's
  std::vector<std::string> participants;  // who rated every stimulus
  std::vector<std::string> left_out;      // who did not
  RatingTable medians;                    // of each participant's ratings of each stimulus
  std::optional<FriedmanTest> friedman;   // of the medians
  std::vector<PairwiseTest> pairwise;     // of the medians; empty where there is no Friedman test
  std::string no_tests;                   // why there are none; empty: there are
};

// Throws InvalidInput for a single step, answers that are no step or mark, and stimuli that the
// block does not have.
RatingResults rating_results(const BlockDesign& design,
                             const std::vector<results::AnswerRow>& answers);
}  // namespace tapstudy::analysis
