#include "analysis/psychometric/comparison.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
void check_standard(double standard) {
  if (!(standard > 0.0) || !std::isfinite(standard)) {
    throw core::InvalidInput{
        fmt::format("a standard is a finite number above 0, not {}", standard)};
  }
}
}  // namespace

ComparisonThresholds comparison_thresholds(core::PsychometricShape shape,
                                           const PsychometricCurve& curve, double standard) {
  check_standard(standard);
  const auto at = [&](double value) {
    return core::shape_quantile(shape, value, curve.threshold, curve.slope);
  };
  ComparisonThresholds result;
  result.point_of_subjective_equality = at(0.5);
  result.just_noticeable_difference = 0.5 * (at(0.75) - at(0.25));
  result.weber_fraction = result.just_noticeable_difference / standard;
  result.constant_error = result.point_of_subjective_equality - standard;
  return result;
}

std::optional<ComparisonIntervals> comparison_intervals(core::PsychometricShape shape,
                                                        const PsychometricIntervals& intervals,
                                                        double standard) {
  check_standard(standard);
  if (core::row_of(shape).is_logarithmic || core::shape_value(shape, 0.0, 0.0, 1.0) != 0.5) {
    return std::nullopt;
  }
  const double unit = core::shape_quantile(shape, 0.75, 0.0, 1.0);
  const Interval difference{unit / intervals.slope.high, unit / intervals.slope.low};
  return ComparisonIntervals{
      intervals.threshold, difference, {difference.low / standard, difference.high / standard}};
}

double weber_fraction(double difference, double standard) {
  check_standard(standard);
  if (!(difference > 0.0) || !std::isfinite(difference)) {
    throw core::InvalidInput{
        fmt::format("a difference threshold is a finite number above 0, not {}", difference)};
  }
  return difference / standard;
}
}  // namespace tapstudy::analysis
