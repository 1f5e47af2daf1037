#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/blocks/psychometric_levels.hpp"
#include "analysis/report/document/block_summary.hpp"
#include "analysis/report/document/cells.hpp"
#include "analysis/report/document/chart.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/psychometric/hierarchical.hpp"
#include "analysis/statistics/psychometric/inference.hpp"
namespace tapstudy::analysis {
// What the answers of a block say of each participant's threshold.

struct ThresholdEstimate {
  PsychometricCurve curve;
  PsychometricIntervals intervals;        // 95 %, by profile likelihood
  bool is_step{};                         // the slope has no upper limit, and is not estimated
  double proportion_at_threshold{};       // correct
  std::optional<GoodnessOfFit> goodness;  // unset where it would take too long
};

struct ParticipantThreshold {
  std::string participant_id;
  std::vector<TrackPoint> track;
  std::vector<Level> levels;  // from low to high
  Proportion correct;         // of trials with a comparison beside a standard
  Proportion false_alarms;    // wrong answers in the others
  std::optional<ThresholdEstimate> estimate;
  std::string no_threshold;                     // why there is none; empty: there is
  std::optional<FitOutcome> outcome;            // unset: too few levels
  std::optional<PosteriorEstimates> posterior;  // unset also where it would take too long
  std::string no_posterior;                     // why there is none; empty: there is, or not sought
  // With half and twice the breadth of the prior; unset where they are left out.
  std::optional<PosteriorEstimates> narrower{};
  std::optional<PosteriorEstimates> broader{};
};

// Of the posteriors' prior, for levels of adaptive tracks, which cover less than the function.
inline constexpr double prior_breadth = 3.0;

// What is reported of one participant: the posterior's median and 95 % credible interval, because
// profile intervals of adaptive tracks hold the threshold in too few studies; where no posterior is
// computed, the likeliest threshold and its profile interval.
struct ReportedThreshold {
  double threshold{};
  Interval interval;
  bool is_posterior{};
};
std::optional<ReportedThreshold> reported_threshold(const ParticipantThreshold& person);
// What enters means and comparisons of participants: the likeliest threshold. Of tracks of 40 to 60
// answers it is right on average, where posterior medians are a tenth too low: an interval over
// participants cannot allow for what all of them share.
std::optional<double> likeliest_threshold(const ParticipantThreshold& person);
// Where the threshold of somebody who has none lies: above or below all levels; unset: unknown.
std::optional<Interval> beyond_levels(const ParticipantThreshold& person);

// Over participants: each one's likeliest threshold counts the same. Standard errors of adaptive
// tracks depend on the thresholds, so that weights by them bias the mean.
struct MeanLogThreshold {
  double mean{};                // of log10 thresholds
  double standard_deviation{};  // of the same: of participants and of their estimates' errors
  Interval interval;            // 95 %, by t with participants - 1 degrees of freedom
  int participants{};           // with a threshold
};

struct ThresholdResults {
  std::vector<ParticipantThreshold> participants;  // by name
  int draws{};                                     // of the tests of fit; 0: not made
  std::optional<MeanLogThreshold> mean_log;        // of two thresholds or more
  std::optional<PopulationFit> population;         // unset also where it would take too long
  bool leaves_out_people() const {
    return mean_log && static_cast<std::size_t>(mean_log->participants) < participants.size();
  }
};

// The block's psychometric function with its guess rate, or a free one, and a lapse rate of up to
// 0.1.
PsychometricModel model_of(const BlockDesign& design);

// Levels are those of comparison_level. Where the guess rate is the participant's own, answers that
// there is a difference where there is none are those at the level 0. Tests of fit and posteriors
// are left out of very large blocks, so that a report takes seconds. Throws InvalidInput where the
// block has no axis, a comparison has no value on it, or an answer is neither right nor wrong.
ThresholdResults participant_thresholds(const BlockDesign& design,
                                        const std::vector<results::AnswerRow>& answers);

// Results as tables, figures and sentences.
std::vector<ReportTable> threshold_tables(const BlockDesign& design,
                                          const ThresholdResults& results);
std::vector<Chart> threshold_charts(const BlockDesign& design, const ThresholdResults& results);
std::vector<CitingText> threshold_remarks(const BlockDesign& design,
                                          const ThresholdResults& results);
// What levels are of, with the axis.
std::string level_words(const VariedAxis& axis);

// A comparison differs from a standard along design.axis, by a level that a procedure chose: each
// participant's psychometric function and threshold, and their mean. Throws InvalidInput as
// participant_thresholds does.
std::shared_ptr<BlockSummary> summarise_thresholds(const BlockDesign& design,
                                                   const BlockRows& rows);
}  // namespace tapstudy::analysis
