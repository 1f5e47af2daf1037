#pragma once
#include <optional>
#include <string>
#include <vector>

#include "analysis/blocks/block_summary.hpp"
#include "analysis/psychometric/inference.hpp"
#include "analysis/psychometric/pooling.hpp"
#include "analysis/psychometric/posterior.hpp"
namespace tapstudy::analysis {
// What the answers of a block say of each participant's threshold.

struct TrackPoint {
  int number{};  // of the trial with a comparison, from 1, in order of time
  double level{};
  bool is_correct{};
};

struct ThresholdEstimate {
  PsychometricCurve curve;
  PsychometricIntervals intervals;        // 95 %, by profile likelihood
  double proportion_at_threshold{};       // correct
  std::optional<GoodnessOfFit> goodness;  // unset where it would take too long
};

struct ParticipantThreshold {
  std::string participant_id;
  std::vector<TrackPoint> track;
  std::vector<Level> levels;  // from low to high
  Proportion correct;         // of trials with a comparison
  Proportion false_alarms;    // wrong answers in trials without one
  std::optional<ThresholdEstimate> estimate;
  std::string no_threshold;                     // why there is none; empty: there is
  std::optional<PosteriorEstimates> posterior;  // unset also where it would take too long
};

struct ThresholdResults {
  std::vector<ParticipantThreshold> participants;  // by name
  int draws{};                                     // of the tests of fit; 0: not made
  bool has_posteriors{};                           // they were computed
  // The mean of log10 thresholds; unset for fewer than two participants with one.
  std::optional<PooledEstimate> pooled_log;
  int pooled_participants{};  // whose threshold has a standard error
};

// The Weibull function with the block's guess rate and a lapse rate of up to 0.1.
PsychometricModel model_of(const BlockDesign& design);

// Levels are VariedAxis::level_of the first comparison of a trial, to nine digits. Tests of fit and
// posteriors are left out of large blocks, so that a report takes seconds at most. Throws
// InvalidInput where the block has no axis, a comparison has no value on it, or an answer is
// neither right nor wrong.
ThresholdResults participant_thresholds(const BlockDesign& design,
                                        const std::vector<results::AnswerRow>& answers);
}  // namespace tapstudy::analysis
