#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "protocols/axes/axis.hpp"
#include "protocols/yaml/yaml_reader.hpp"
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

// Two ends, and how what lies between them is spaced.
struct SpacedEnds {
  double low{};
  double high{};  // > low; for log spacing both > 0
  Spacing spacing{};
};
// The key `spacing`, linear or log; linear if it is not given.
Spacing read_spacing(MapReader& reader);
// Whether values from the lowest on can be spaced so; notes the problem.
bool check_spacing(MapReader& reader, Spacing spacing, double lowest);

struct EndKeys {
  std::string low;
  std::string high;
};
// Of the keys of the ends and of `spacing`, linear or log. nullopt: a problem was noted.
std::optional<SpacedEnds> read_ends(MapReader& reader, const EndKeys& keys, const Range& allowed);

struct SpacedValues {
  std::vector<double> values;  // strictly increasing
  Spacing spacing{};
};
// Equally spaced: the same keys and `count`, from 2. nullopt: a problem was noted.
std::optional<SpacedValues> read_spaced(MapReader& reader, const EndKeys& keys,
                                        const Range& allowed, int max_count);
}  // namespace tapstudy::protocols
