#include "analysis/blocks/wording.hpp"

#include <fmt/format.h>
namespace tapstudy::analysis {
std::string fraction(const Proportion& proportion) {
  return fmt::format("{}/{}", proportion.successes, proportion.trials);
}

std::string percent(const Proportion& proportion) {
  return proportion.trials == 0 ? "–" : fmt::format("{:.0f} %", 100.0 * proportion.value());
}

std::string with_interval(const Proportion& proportion) {
  if (proportion.trials == 0) {
    return "no answers";
  }
  const Interval interval = wilson_interval(proportion);
  return fmt::format("{} = {} (95 % CI {:.0f}–{:.0f} %)", fraction(proportion), percent(proportion),
                     100.0 * interval.low, 100.0 * interval.high);
}

std::string p_value(double p) {
  if (p < 0.001) {
    return "p < .001";
  }
  const std::string digits = fmt::format("{:.3f}", p);
  return "p = " + (digits.front() == '0' ? digits.substr(1) : digits);
}
}  // namespace tapstudy::analysis
