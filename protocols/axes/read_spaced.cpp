#include "protocols/axes/read_spaced.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
namespace tapstudy::protocols {
Spacing read_spacing(MapReader& reader) {
  return reader.one_of<Spacing>("spacing", {{"linear", Spacing::linear}, {"log", Spacing::log}},
                                "linear");
}

bool check_spacing(MapReader& reader, Spacing spacing, double lowest) {
  const bool is_possible = spacing == Spacing::linear || lowest > 0.0;
  if (!is_possible) {
    reader.reject("spacing", fmt::format("log needs values above 0, not {}", lowest));
  }
  return is_possible;
}

std::optional<SpacedEnds> read_ends(MapReader& reader, const EndKeys& keys, const Range& allowed) {
  const std::size_t earlier_problems = reader.problems_in_file();
  SpacedEnds ends;
  ends.low = reader.number(keys.low, allowed);
  ends.high = reader.number(keys.high, allowed);
  ends.spacing = read_spacing(reader);
  if (reader.problems_in_file() > earlier_problems) {
    return std::nullopt;
  }
  if (!(ends.low < ends.high)) {
    reader.reject(keys.low, fmt::format("{} is not below {}, {}", ends.low, keys.high, ends.high));
    return std::nullopt;
  }
  return check_spacing(reader, ends.spacing, ends.low) ? std::optional{ends} : std::nullopt;
}

std::optional<SpacedValues> read_spaced(MapReader& reader, const EndKeys& keys,
                                        const Range& allowed, int max_count) {
  const std::size_t earlier_problems = reader.problems_in_file();
  const int count = reader.integer("count", 2, max_count);
  const std::optional<SpacedEnds> ends = read_ends(reader, keys, allowed);
  if (!ends || reader.problems_in_file() > earlier_problems) {
    return std::nullopt;
  }
  SpacedValues spaced_values{spaced(ends->low, ends->high, count, ends->spacing), ends->spacing};
  const std::vector<double>& values = spaced_values.values;
  if (std::ranges::adjacent_find(values, std::greater_equal{}) != values.end()) {
    reader.reject("count", fmt::format("is too high: values between {} and {} are no longer "
                                       "distinct",
                                       keys.low, keys.high));
    return std::nullopt;
  }
  return spaced_values;
}
}  // namespace tapstudy::protocols
