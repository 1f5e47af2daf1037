#pragma once
#include <optional>

#include "analysis/psychometric/fit.hpp"
#include "analysis/psychometric/inference.hpp"
namespace tapstudy::analysis {
// Comparisons with a standard: psi is the proportion of "the comparison is more" as a function of
// the comparison's value, F = psi without guess and lapse rate (Gescheider 1997, ch. 3).
struct ComparisonThresholds {
  double point_of_subjective_equality{};  // F = 1/2
  double just_noticeable_difference{};    // half the distance from F = 1/4 to F = 3/4
  double weber_fraction{};                // the difference over the standard
  double constant_error{};                // the point of equality less the standard
};
// standard > 0, else throws InvalidInput.
ComparisonThresholds comparison_thresholds(core::PsychometricShape shape,
                                           const PsychometricCurve& curve, double standard);

// The same of the ends of intervals, for shapes on a linear axis that are at 1/2 at their threshold
// (there the point is the threshold, and the difference is inverse to the slope); nullopt for
// others.
struct ComparisonIntervals {
  Interval point_of_subjective_equality;
  Interval just_noticeable_difference;
  Interval weber_fraction;
};
std::optional<ComparisonIntervals> comparison_intervals(core::PsychometricShape shape,
                                                        const PsychometricIntervals& intervals,
                                                        double standard);

// Of a difference threshold, however it was measured: difference / standard, both > 0, else throws
// InvalidInput.
double weber_fraction(double difference, double standard);
}  // namespace tapstudy::analysis
