#include "analysis/report/wording.hpp"

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

std::string multinomial_words(const ChoiceSummary& summary) {
  return summary.multinomial_p ? p_value(*summary.multinomial_p)
                               : "not computed, too many possible outcomes";
}

std::string title_of(const FactorResult& result) {
  return result.given.empty() ? result.factor
                              : fmt::format("{}, given {} is right", result.factor, result.given);
}

bool is_simulated(const Summary& summary) {
  return summary.modes.find("simulated") != std::string::npos;
}

std::string methods(const Summary& summary) {
  if (summary.modes == "counts") {
    return "Computed from a table of counts; participants are not known, so intervals (Wilson "
           "1927) "
           "treat all answers as independent.";
  }
  std::string text = fmt::format("{} participants ({}). ", summary.participants, summary.modes);
  text +=
      "Intervals are 95 % score intervals (Wilson 1927); pooled over participants they treat "
      "answers "
      "as independent. Accuracy is tested by shuffling each participant's responses over that "
      "participant's own trials, choices by the exact binomial and multinomial distributions. ";
  if (summary.loop) {
    text += fmt::format(
        "The haptic loop made {} ticks; {} were late, {} were skipped, and {} force samples were "
        "lost.",
        summary.loop->ticks, summary.loop->late, summary.loop->skipped,
        summary.loop->dropped_samples);
  }
  return text;
}
}  // namespace tapstudy::analysis
