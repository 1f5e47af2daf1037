#pragma once
#include <optional>
#include <vector>

#include "protocols/yaml/yaml_reader.hpp"
namespace tapstudy::protocols {
// Values of a stimulus or a parameter, in its own unit.
inline constexpr double largest_value = 1e9;
inline constexpr int max_grid_values = 10'000;

// The keys of a grid: `values`, listed in increasing order; or `min`, `max`, `count` and `spacing`,
// linear or log. At least one value, strictly increasing. nullopt: a problem was noted.
std::optional<std::vector<double>> read_grid(MapReader& reader);
}  // namespace tapstudy::protocols
