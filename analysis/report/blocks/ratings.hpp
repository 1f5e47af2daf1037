#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/document/block_summary.hpp"
#include "analysis/report/document/cells.hpp"
#include "analysis/statistics/friedman_test.hpp"
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

inline constexpr std::uint64_t friedman_seed = 9;
inline constexpr auto words_of_permutation =
    "The test of all has p by permuting each participant's ranks: of all orders where they can be "
    "counted, else of 9999.";
// "friedman": one row, none without a test.
ReportTable friedman_table(const std::optional<FriedmanTest>& test, std::size_t participants);

// "participants": a row for each participant and stimulus, for programs. values: [participant]
// [stimulus].
ReportTable participant_values_table(const std::string& title, const Column& of,
                                     const std::vector<std::string>& participants,
                                     const std::vector<std::string>& stimuli,
                                     const RatingTable& values);
// "WHAT: STIMULUS", the mean of the participants' values with its bounded_interval; of two
// participants or more who differ. values: [participant][stimulus].
std::vector<MainResult> means_over_participants(const std::string& what,
                                                const std::vector<std::string>& stimuli,
                                                const std::vector<std::vector<double>>& values,
                                                const Interval& bounds);

// Ratings of one presented stimulus a trial: their distribution, Friedman's test over participants,
// pairwise signed-rank tests. Throws InvalidInput as rating_results does, and for a hypothesis
// about no stimulus of the block.
std::shared_ptr<BlockSummary> summarise_ratings(const BlockDesign& design, const BlockRows& rows);
}  // namespace tapstudy::analysis
