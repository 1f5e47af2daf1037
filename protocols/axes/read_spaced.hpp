#pragma once
#include <optional>
#include <vector>

#include "protocols/axes/axis_range.hpp"
#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
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
  const char* low;
  const char* high;
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
