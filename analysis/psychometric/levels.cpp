#include "analysis/psychometric/levels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
void check(const Level& level, const core::PsychometricShapeRow& row) {
  if (level.answers.trials < 0 || level.answers.successes < 0 ||
      level.answers.successes > level.answers.trials) {
    throw core::InvalidInput{fmt::format("at {}: {} of {} answers are not possible", level.value,
                                         level.answers.successes, level.answers.trials)};
  }
  if (!std::isfinite(level.value) || (row.is_logarithmic && level.value < 0.0)) {
    throw core::NotEstimable{fmt::format("{}: a value is a finite number{}, not {}", row.name,
                                         row.is_logarithmic ? " of at least 0" : "", level.value)};
  }
}
}  // namespace

std::vector<Level> checked_levels(const std::vector<Level>& levels, core::PsychometricShape shape) {
  const core::PsychometricShapeRow& row = core::row_of(shape);
  std::vector<Level> sorted = levels;
  std::ranges::sort(sorted, {}, &Level::value);
  std::vector<Level> merged;
  for (const Level& level : sorted) {
    check(level, row);
    if (level.answers.trials == 0) {
      continue;
    }
    if (!merged.empty() && merged.back().value == level.value) {
      merged.back().answers.successes += level.answers.successes;
      merged.back().answers.trials += level.answers.trials;
    } else {
      merged.push_back(level);
    }
  }
  const auto usable = std::ranges::count_if(
      merged, [&](const Level& level) { return !row.is_logarithmic || level.value > 0.0; });
  if (usable < 2) {
    throw core::NotEstimable{fmt::format(
        "{}: a psychometric function takes answers at two different values{} or more, not {}",
        row.name, row.is_logarithmic ? " above 0" : "", usable)};
  }
  return merged;
}

double on_axis(core::PsychometricShape shape, double value) {
  return core::row_of(shape).is_logarithmic ? std::log10(value) : value;
}

double from_axis(core::PsychometricShape shape, double position) {
  return core::row_of(shape).is_logarithmic ? std::pow(10.0, position) : position;
}

AxisRange axis_range(const std::vector<Level>& levels, core::PsychometricShape shape) {
  AxisRange range{0.0, 0.0, std::numeric_limits<double>::infinity()};
  bool is_first = true;
  for (const Level& level : levels) {
    const double position = on_axis(shape, level.value);
    if (!std::isfinite(position)) {
      continue;
    }
    if (is_first) {
      range.low = position;
    } else {
      range.smallest_gap = std::min(range.smallest_gap, position - range.high);
    }
    range.high = position;
    is_first = false;
  }
  constexpr double rounding = 1e-6;  // levels nearer than this are no step apart
  range.smallest_gap = std::max(range.smallest_gap, rounding * range.length());
  return range;
}
}  // namespace tapstudy::analysis
