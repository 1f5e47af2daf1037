#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/document/block_summary.hpp"
#include "analysis/statistics/friedman_test.hpp"
#include "analysis/statistics/scaling/preference_scales.hpp"
namespace tapstudy::analysis {
// Orders of all stimuli of a block, the best first.
struct RankingResults {
  std::vector<std::string> stimuli;      // in the order of the block's
  std::vector<std::vector<int>> places;  // [stimulus][place]: how often, of all rankings
  int rankings{};
  std::vector<std::string> participants;  // by name
  RatingTable mean_places;                // of each participant's rankings; 1 is the best
  std::optional<FriedmanTest> friedman;   // of these
  std::vector<PairwiseTest> pairwise;     // of these; empty where there is no Friedman test
  std::string no_tests;                   // why there are none; empty: there are
  std::optional<PreferenceScale> worths;  // of all rankings, by Plackett and Luce
  std::string no_worths;                  // why there are none; empty: there are
};

// An answer is the names of the stimuli, with a space between. Throws InvalidInput for others.
RankingResults ranking_results(const BlockDesign& design,
                               const std::vector<results::AnswerRow>& answers);

// Rankings of all stimuli: mean ranks with Kendall's W and Friedman's test over participants, and
// worths by Plackett and Luce. Throws InvalidInput as ranking_results does.
std::shared_ptr<BlockSummary> summarise_rankings(const BlockDesign& design, const BlockRows& rows);
}  // namespace tapstudy::analysis
