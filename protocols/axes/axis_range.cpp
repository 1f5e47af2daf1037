#include "protocols/axes/axis_range.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::protocols {
namespace {
constexpr double rounding = 1e-9;  // of a value computed through logarithms, relative

// 0.06 instead of 0.060000000000000005, as a study would state it.
double written_short(double value) {
  return core::number_in<double>(fmt::format("{:.12g}", value)).value_or(value);
}

double distance(double a, double b, Spacing spacing) {
  return spacing == Spacing::log ? std::abs(std::log(a / b)) : std::abs(a - b);
}

std::string with_unit(const std::string& words, std::string_view unit) {
  return unit.empty() ? words : fmt::format("{} {}", words, unit);
}
}  // namespace

double between(double from, double to, Spacing spacing, double share) {
  return spacing == Spacing::log ? from * std::pow(to / from, share) : from + share * (to - from);
}

double AxisRange::at(double share) const {
  return between(from, to, spacing, share);
}

double AxisRange::presented(double asked) const {
  const double slack = rounding * std::max(std::abs(from), std::abs(to));
  if (!(asked >= from - slack && asked <= to + slack)) {
    throw core::InvalidInput{
        fmt::format("{}: {} is not allowed ({})", axis->name, asked,
                    with_unit(fmt::format("from {} to {}", from, to), axis->unit))};
  }
  const double inside = std::clamp(asked, from, to);
  if (axis->kind == AxisKind::scaled) {
    return inside;
  }
  return *std::ranges::min_element(table, {},
                                   [&](double value) { return distance(value, inside, spacing); });
}

std::string AxisRange::described() const {
  const std::string values = axis->kind == AxisKind::tabled
                                 ? fmt::format("{} {}", axis->name, fmt::join(table, ", "))
                                 : fmt::format("{} from {} to {}", axis->name, from, to);
  return with_unit(values, axis->unit);
}

std::vector<double> spaced(double from, double to, int count, Spacing spacing) {
  std::vector<double> values;
  for (int i = 0; i + 1 < count; ++i) {
    values.push_back(
        written_short(between(from, to, spacing, static_cast<double>(i) / (count - 1))));
  }
  values.push_back(to);
  return values;
}

std::string described(const AxisValues& values) {
  std::vector<std::string> words;
  for (const auto& [name, value] : values) {
    words.push_back(fmt::format("{} = {:.6g}", name, value));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

Spacing read_spacing(MapReader& reader) {
  return reader.one_of<Spacing>({"spacing", "equal differences or equal ratios between values"},
                                {{"linear", Spacing::linear}, {"log", Spacing::log}}, "linear");
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
  ends.low = reader.number({keys.low, "lowest value"}, allowed);
  ends.high = reader.number({keys.high, "highest value, above " + keys.low}, allowed);
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
  const int count = reader.integer({"count", "how many values, both ends included"}, 2, max_count);
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
