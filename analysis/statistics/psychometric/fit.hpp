#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "analysis/statistics/psychometric/climb.hpp"
namespace tapstudy::analysis {
// The model that is fitted. A rate with low = high is fixed, others are free within [low, high].
struct PsychometricModel {
  core::PsychometricShape shape{};
  Interval guess{0.0, 0.0};      // 1/m for a choice among m
  Interval lapse{0.0, 0.1};      // Wichmann & Hill 2001a bound it by 0.06
  Rates rates{Rates::separate};  // equal: `guess` is not used
};

enum class FitOutcome {
  fitted,
  all_successes,    // at every level
  no_successes,     // at any level
  no_increase,      // a constant proportion is as likely as any increasing function
  step,             // a step between or at levels is as likely: the slope has no upper limit, and
                    // the threshold is known as curve_with_threshold and
                    // profile_intervals say
  threshold_below,  // the threshold lies below the lowest level
  threshold_above   // above the highest
};
// The meaning of an outcome, as a clause: "the answers do not increase with the value".
std::string_view explanation(FitOutcome outcome);

struct PsychometricCurve {
  double threshold{};
  double slope{};
  double guess{};
  double lapse{};
};

struct PsychometricFit {
  FitOutcome outcome{};
  std::optional<PsychometricCurve> curve;  // if fitted: none is made up for other outcomes
  Maximum maximum;                         // where the search ended, whatever the outcome
  double deviance{};
};

// Maximum likelihood of binomial answers (Wichmann & Hill 2001a; threshold, slope and free rates).
// With guess = lapse = 0 it is a generalised linear model with the logit, probit or complementary
// log-log link. Throws InvalidInput as checked_levels does, and for rates that are not 0 <= low <=
// high with guess.high + lapse.high < 1.
PsychometricFit fit_psychometric(const PsychometricModel& model, const std::vector<Level>& levels);

// The likelihood of these levels. Throws InvalidInput as checked_levels does.
BinomialLikelihood likelihood_of(const PsychometricModel& model, const std::vector<Level>& levels);
// The box that fit_psychometric searches: thresholds up to three times the levels' range beyond
// them, slopes from nearly constant to a step within the smallest gap.
PsychometricBox search_box(const PsychometricModel& model, const std::vector<Level>& levels);
}  // namespace tapstudy::analysis
