#include "protocols/procedures/read_grid.hpp"

#include <algorithm>
#include <functional>

#include "protocols/axes/read_spaced.hpp"
namespace tapstudy::protocols {
namespace {
std::optional<std::vector<double>> listed(MapReader& reader) {
  for (const char* key : {"min", "max", "count", "spacing"}) {
    if (reader.has(key)) {
      reader.reject(key, "is not for values that are listed");
    }
  }
  std::vector<double> values = reader.number_list("values", {-largest_value, largest_value});
  if (values.size() > max_grid_values) {
    reader.reject("values", "are too many (at most 10000)");
    return std::nullopt;
  }
  if (values.empty() || std::ranges::adjacent_find(values, std::greater_equal{}) != values.end()) {
    reader.reject("values", "are not in increasing order, each once");
    return std::nullopt;
  }
  return values;
}
}  // namespace

std::optional<std::vector<double>> read_grid(MapReader& reader) {
  if (reader.has("values")) {
    return listed(reader);
  }
  const auto spaced =
      read_spaced(reader, {"min", "max"}, {-largest_value, largest_value}, max_grid_values);
  return spaced ? std::optional{spaced->values} : std::nullopt;
}
}  // namespace tapstudy::protocols
