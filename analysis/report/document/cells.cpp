#include "analysis/report/document/cells.hpp"

#include <fmt/format.h>

#include <cmath>

#include "analysis/report/document/wording.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/quantiles.hpp"
namespace tapstudy::analysis {
std::string rounded(double value, int significant_digits) {
  if (std::isnan(value)) {
    return "–";
  }
  if (std::isinf(value)) {
    return value > 0.0 ? "∞" : "−∞";
  }
  // whole numbers of up to six digits keep them all
  const double size = std::abs(value);
  const bool is_plain = size >= 100.0 && size < 999'999.5;
  if (value == 0.0) {
    return "0";  // whatever its sign
  }
  return is_plain ? fmt::format("{:.0f}", value)
                  : fmt::format("{:.{}g}", value, significant_digits);
}

std::string with_interval(double value, const Interval& interval) {
  return fmt::format("{} ({} to {})", rounded(value), rounded(interval.low),
                     rounded(interval.high));
}

Cell word(const CitingText& text) {
  return {text, {text.words}};
}
Cell labelled(const Item& item) {
  return {item.label, {item.name}};
}

Cell count(std::int64_t number) {
  return {fmt::format("{}", number), {number}};
}

Cell flag(bool is_so) {
  return {is_so ? "yes" : "no", {is_so}};
}

Cell number(double value, int significant_digits) {
  return {rounded(value, significant_digits), {value}};
}

Cell number(const std::optional<double>& value) {
  return value ? number(*value) : Cell{"–", {Value{}}};
}

Cell share(double value) {
  return {fmt::format("{:.0f} %", 100.0 * value), {value}};
}

Cell probability(const std::optional<double>& p) {
  return p ? Cell{p_value(*p), {*p}} : Cell{"–", {Value{}}};
}

Cell interval(double value, const Interval& interval) {
  return {with_interval(value, interval), {value, interval.low, interval.high}};
}

Cell interval(double value, const std::optional<Interval>& range) {
  return range ? interval(value, *range) : Cell{rounded(value), {value, Value{}, Value{}}};
}

Cell difference_or_ratio(double difference, const std::optional<Interval>& range, bool is_ratio) {
  if (!is_ratio) {
    return interval(difference, range);
  }
  return interval(
      std::exp(difference),
      range ? std::optional{Interval{std::exp(range->low), std::exp(range->high)}} : std::nullopt);
}

Cell people_known(std::int64_t known, std::int64_t took_part) {
  Cell cell = count(known);
  cell.values.emplace_back(took_part);
  if (known < took_part) {
    cell.text = fmt::format("{} of {}", known, took_part);
  }
  return cell;
}

Cell interval_above_zero(double value, const Interval& range) {
  return interval(value, range.high > 0.0 ? std::optional{range} : std::nullopt);
}

Cell mean_with_interval(const std::vector<double>& values) {
  return interval(mean_and_spread(values).mean,
                  values.size() > 1 ? std::optional{t_interval(values)} : std::nullopt);
}

Cell mean_of_positive(const std::vector<double>& values) {
  return interval(mean_and_spread(values).mean,
                  values.size() > 1 ? std::optional{positive_interval(values)} : std::nullopt);
}

Cell proportion(const Proportion& proportion) {
  if (proportion.trials == 0) {
    return {with_interval(proportion),
            {proportion.successes, proportion.trials, Value{}, Value{}, Value{}}};
  }
  const Interval interval = wilson_interval(proportion);
  return {
      with_interval(proportion),
      {proportion.successes, proportion.trials, proportion.value(), interval.low, interval.high}};
}

Cell counted(const Proportion& proportion) {
  return {fraction_and_percent(proportion),
          {proportion.successes, proportion.trials,
           proportion.trials == 0 ? Value{} : Value{proportion.value()}}};
}

Cell nothing(const Column& column, const std::string& text) {
  return {text, std::vector<Value>(column.keys.size())};
}

Column column(const CitingText& heading, const std::string& key) {
  return {heading, {key}};
}

Column interval_column(const CitingText& heading, const std::string& key) {
  return {heading, {key, key + "_low", key + "_high"}};
}

Column counted_column(const CitingText& heading, const std::string& key) {
  return {heading, {key, key + "_of", key + "_share"}};
}

Column people_column(const CitingText& heading, const std::string& key) {
  return {heading, {key, key + "_of"}};
}

Column proportion_column(const CitingText& heading, const std::string& key) {
  return {heading, {key, key + "_of", key + "_share", key + "_share_low", key + "_share_high"}};
}
}  // namespace tapstudy::analysis
