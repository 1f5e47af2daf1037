#pragma once
#include <map>
#include <string>
#include <vector>

#include "protocols/axes/axis.hpp"
namespace tapstudy::protocols {
// Values by the names of their axes, each in its axis's unit.
using AxisValues = std::map<std::string, double>;

// Whether steps along an axis are equal differences or equal ratios.
enum class Spacing { linear, log };

// How far a stimulus varies along an axis, its entry in `vary`.
struct AxisRange {
  const Axis* axis{};
  double from{};
  double to{};  // > from; for log spacing both > 0
  Spacing spacing{Spacing::linear};
  std::vector<double> table{};  // of a tabled axis: what can be presented, ascending

  // The value itself on a scaled axis; on a tabled one the nearest of the table, by difference or
  // ratio as it is spaced, the lower of two equally near. Rounding beyond an end is cut off. Throws
  // InvalidInput for other values outside the range and for NaN.
  double presented(double asked) const;
  // share 0: from, 1: to, by difference or ratio as it is spaced.
  double at(double share) const;
  // "youngs_modulus_pa from 1e+09 to 5e+09 Pa", "thickness_m 0.01, 0.02 m".
  std::string described() const;
};

// What lies between two values, at a share of 0 to 1 of their difference, or logarithms'
// difference.
double between(double from, double to, Spacing spacing, double share);

// `count` (2 or more) values from `from` to `to`, both included, equally spaced, rounded to
// 12 digits.
std::vector<double> spaced(double from, double to, int count, Spacing spacing);

// "a = 1, b = 2".
std::string described(const AxisValues& values);
}  // namespace tapstudy::protocols
