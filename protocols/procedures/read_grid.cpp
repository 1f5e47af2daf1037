#include "protocols/procedures/read_grid.hpp"

#include <algorithm>
#include <cmath>
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

// Both ends exactly.
std::vector<double> spaced(double low, double high, int count, bool is_log) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    const double part = static_cast<double>(i) / (count - 1);
    values.push_back(is_log ? low * std::pow(high / low, part) : low + part * (high - low));
  }
  values.back() = high;
  return values;
}
}  // namespace

std::optional<std::vector<double>> read_grid(MapReader& reader) {
  if (reader.has("values")) {
    return listed(reader);
  }
  const double low = reader.number("min", {-largest_value, largest_value});
  const double high = reader.number("max", {-largest_value, largest_value});
  const int count = reader.integer("count", 2, max_grid_values);
  const bool is_log = reader.one_of<bool>("spacing", {{"linear", false}, {"log", true}}, "linear");
  if (high <= low) {
    reader.reject("max", "is not above min");
    return std::nullopt;
  }
  if (is_log && low <= 0.0) {
    reader.reject("min", "is not above 0, as logarithmic spacing needs");
    return std::nullopt;
  }
  std::vector<double> values = spaced(low, high, count, is_log);
  if (std::ranges::adjacent_find(values, std::greater_equal{}) != values.end()) {
    reader.reject("count", "is too high: values between min and max are no longer distinct");
    return std::nullopt;
  }
  return values;
}
}  // namespace tapstudy::protocols
