#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/blocks/psychometric_levels.hpp"
#include "analysis/report/document/block_summary.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/psychometric/inference.hpp"
namespace tapstudy::analysis {
// Comparisons on either side of a standard: how often they are judged greater, from never to
// always. Levels are VariedAxis::level_of, below the standard negative.

// psi is the block's function, on a linear axis, with one rate of up to 0.1 (Wichmann & Hill
// 2001a) at which answers are wrong whatever the level, its value at F = 0.5 the point of
// subjective equality (PSE), half of the distance from F = 0.25 to F = 0.75 the just noticeable
// difference (JND).
struct EqualityEstimate {
  PsychometricCurve curve;
  Interval equality;          // 95 %, by profile likelihood; of levels
  std::optional<double> jnd;  // a level; unset where the answers change in a step: below its limit
  Interval jnd_interval;
  std::optional<GoodnessOfFit> goodness;  // unset where only main results are wanted
};

struct ParticipantEquality {
  std::string participant_id;
  std::vector<Level> levels;      // judged greater, from low to high
  std::vector<TrackPoint> track;  // of those judged greater
  std::optional<EqualityEstimate> estimate;
  std::string no_estimate;  // why there is none; empty: there is
};

struct EqualityResults {
  std::vector<ParticipantEquality> participants;  // by name
  // Over participants with an estimate, each as one: of PSEs, whose distance from the standard is
  // tested; and of log10 JNDs. Unset for fewer than two.
  std::optional<PairedContrast> equality;
  std::optional<PairedContrast> log_jnd;
};

PsychometricModel equality_model(const BlockDesign& design);

// Throws InvalidInput where the block has no axis, a comparison has no value on it, or an answer
// names no alternative.
EqualityResults equality_results(const BlockDesign& design,
                                 const std::vector<results::AnswerRow>& answers);

// Points of subjective equality and just noticeable differences from comparisons on either side of
// a standard. Throws InvalidInput as equality_results does.
std::shared_ptr<BlockSummary> summarise_equality(const BlockDesign& design, const BlockRows& rows);
}  // namespace tapstudy::analysis
