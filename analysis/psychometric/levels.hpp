#pragma once
#include <vector>

#include "analysis/statistics/proportion.hpp"
#include "core/psychometric_function.hpp"
namespace tapstudy::analysis {
// The answers at one value of the stimulus: k of one kind ("correct", "stronger") in n.
struct Level {
  double value{};
  Proportion answers;
};

// Sorted by value, equal values put together, those without trials left out. Throws InvalidInput
// for counts that are not possible (0 <= k <= n), values that the shape does not allow (below 0 on
// a logarithmic axis), and fewer than two different values (above 0 on a logarithmic axis).
std::vector<Level> checked_levels(const std::vector<Level>& levels, core::PsychometricShape shape);

// The value on the shape's axis: itself or its logarithm to base 10, and back.
double on_axis(core::PsychometricShape shape, double value);
double from_axis(core::PsychometricShape shape, double position);

// Where the levels lie on the axis: the two outermost and the smallest distance between two, but
// for what may be rounding.
// levels as checked; a value of 0 on a logarithmic axis is left out.
struct AxisRange {
  double low{};
  double high{};
  double smallest_gap{};
  double length() const { return high - low; }
};
AxisRange axis_range(const std::vector<Level>& levels, core::PsychometricShape shape);
}  // namespace tapstudy::analysis
