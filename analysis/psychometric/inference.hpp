#pragma once
#include <cstdint>

#include "analysis/psychometric/fit.hpp"
namespace tapstudy::analysis {
// Intervals by profile likelihood (Venzon & Moolgavkar 1988): the values whose likelihood,
// maximised over all other parameters, is below the greatest by no more than half the quantile of
// chi-squared with one degree of freedom. An end that the search box does not hold is infinite (0
// for slopes and for thresholds on a logarithmic axis).
struct PsychometricIntervals {
  Interval threshold;
  Interval slope;
};
// Throws InvalidInput as fit_psychometric does, where no threshold was found (an outcome other than
// fitted and step), and for a confidence outside (0, 1).
PsychometricIntervals profile_intervals(const PsychometricModel& model,
                                        const std::vector<Level>& levels, double confidence = 0.95);

// The curve of a fit to these levels that determines a threshold, else nullopt. Where the outcome
// is a step: its threshold is the middle, on the shape's axis, of those that are as likely as the
// likeliest, its slope the steepest that the search box holds; standard errors NaN.
std::optional<PsychometricCurve> curve_with_threshold(const PsychometricModel& model,
                                                      const std::vector<Level>& levels,
                                                      const PsychometricFit& fit);

struct GoodnessOfFit {
  double deviance{};
  double p{};  // (1 + draws with at least this deviance) / (draws + 1): small if the fit is bad
  int draws{};
};
// The deviance against its distribution under the fitted function, by drawing answers anew and
// fitting them (parametric bootstrap; Wichmann & Hill 2001a), because chi-squared is a poor
// approximation for few trials a level. The same seed gives the same p. Throws InvalidInput as
// fit_psychometric does and for draws < 1.
GoodnessOfFit deviance_test(const PsychometricModel& model, const std::vector<Level>& levels,
                            int draws, std::uint64_t seed);

}  // namespace tapstudy::analysis
