#include "analysis/thresholds/comparison_level.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
double to_nine_digits(double level) {
  if (level == 0.0 || !std::isfinite(level)) {
    return level;
  }
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(level))) - 8.0);
  return std::round(level / unit) * unit;
}
}  // namespace

std::optional<double> comparison_level(const BlockDesign& design,
                                       const results::AnswerRow& answer) {
  const auto comparison =
      std::ranges::find_if(answer.alternatives, &results::AlternativeRow::is_comparison);
  if (comparison == answer.alternatives.end() ||
      std::ranges::all_of(answer.alternatives, &results::AlternativeRow::is_comparison)) {
    return std::nullopt;
  }
  const auto value = comparison->axis_values.find(design.axis->name.key);
  if (value == comparison->axis_values.end()) {
    throw core::InvalidInput{
        fmt::format("block '{}': the comparison of {} in trial {} has no value of '{}'",
                    design.name, answer.participant_id, answer.number, design.axis->name.key)};
  }
  return to_nine_digits(design.axis->level_of(value->second));
}

void count_at(std::vector<Level>& levels, double level, bool is_success) {
  auto at = std::ranges::lower_bound(levels, level, {}, &Level::value);
  if (at == levels.end() || at->value != level) {
    at = levels.insert(at, {level, {}});
  }
  at->answers.add(is_success);
}
}  // namespace tapstudy::analysis
