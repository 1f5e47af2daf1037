#include "runner/experiments/screens.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "protocols/schedule.hpp"
#include "runner/experiments/counted.hpp"
#include "runner/session/between_trials.hpp"
#include "runner/session/session_row.hpp"
namespace tapstudy::runner {
namespace {
// What a screen takes, roughly, from what one sees in laboratories: not measured.
constexpr double instructions_s = 30.0;
constexpr double question_s = 8.0;
constexpr double decision_s = 5.0;
constexpr double mounting_s = 20.0;
constexpr double confidence_s = 3.0;
constexpr double feedback_s = 2.0;
constexpr double rest_s = 30.0;
constexpr double max_rest_s = 3600.0;  // that a protocol can ask for

void add_instructions(const std::string& text, const std::string& whose,
                      std::vector<ScreenGroup>& screens) {
  if (!text.empty()) {
    screens.push_back({"instructions of " + whose, 1, instructions_s});
  }
}

void add_forms(const protocols::Protocol& protocol, const std::vector<std::string>& names,
               std::vector<ScreenGroup>& screens) {
  for (const std::string& name : names) {
    const std::size_t items = protocol.forms.at(name).items.size();
    screens.push_back({fmt::format("questionnaire {}: {}", name, counted(items, "question")), 1,
                       question_s * static_cast<double>(items)});
  }
}

// Trials and what comes after each.
std::vector<ScreenGroup> trial_screens(const protocols::Block& block) {
  const int trials = protocols::planned_trials(block);
  const bool is_mounted = block.presented == protocols::Presented::real_plates;
  std::vector<ScreenGroup> screens{
      {fmt::format("{}: {}{}", block.name, may_end_early(block) ? "at most " : "",
                   counted(static_cast<std::size_t>(trials), "trial")),
       trials, trials * (decision_s + (is_mounted ? mounting_s : 0.0))}};
  if (block.confidence) {
    screens.push_back({fmt::format("confidence in {} steps, after each", block.confidence->steps),
                       trials, trials * confidence_s});
  }
  if (block.gives_feedback) {
    screens.push_back({"feedback, after each", trials, trials * feedback_s});
  }
  return screens;
}

// In a block that takes so long without them, the last trial being followed by none.
int number_of(const protocols::Breaks& breaks, int trials, double block_s) {
  int number = breaks.every_trials ? (trials - 1) / *breaks.every_trials : 0;
  if (breaks.every_seconds) {
    number = std::max(number, static_cast<int>(block_s / *breaks.every_seconds));
  }
  return std::min(number, trials - 1);
}

std::string length_of(const protocols::Breaks& breaks) {
  if (!breaks.max_seconds) {
    return breaks.min_seconds > 0.0 ? fmt::format(" of at least {} s", breaks.min_seconds) : "";
  }
  if (breaks.min_seconds == *breaks.max_seconds) {
    return fmt::format(" of {} s", breaks.min_seconds);
  }
  return breaks.min_seconds > 0.0
             ? fmt::format(" of {} to {} s", breaks.min_seconds, *breaks.max_seconds)
             : fmt::format(" of at most {} s", *breaks.max_seconds);
}

std::string described(const protocols::Breaks& breaks) {
  std::vector<std::string> after;
  if (breaks.every_trials) {
    after.push_back(counted(static_cast<std::size_t>(*breaks.every_trials), "trial"));
  }
  if (breaks.every_seconds) {
    after.push_back(fmt::format("{} s", *breaks.every_seconds));
  }
  return fmt::format("a break{}, after every {}", length_of(breaks), fmt::join(after, " or "));
}

void add_trials(const protocols::Protocol& protocol, const protocols::Block& block,
                std::vector<ScreenGroup>& screens) {
  const std::vector<ScreenGroup> own = trial_screens(block);
  screens.insert(screens.end(), own.begin(), own.end());
  if (block.breaks) {
    const int trials = protocols::planned_trials(block);
    double block_s = trials * simulated_trial_s(protocol, block);
    for (const ScreenGroup& group : own) {
      block_s += group.seconds;
    }
    const int count = number_of(*block.breaks, trials, block_s);
    const double each_s = std::clamp(rest_s, block.breaks->min_seconds,
                                     block.breaks->max_seconds.value_or(max_rest_s));
    screens.push_back({described(*block.breaks), count, count * each_s});
  }
}
}  // namespace

std::vector<ScreenGroup> screens_of(const protocols::Protocol& protocol) {
  std::vector<ScreenGroup> screens;
  add_instructions(protocol.instructions, "the study", screens);
  add_forms(protocol, protocol.forms_before, screens);
  const protocols::Block* before = nullptr;
  for (const protocols::Block& block : protocol.blocks) {
    add_instructions(block.instructions, block.name, screens);
    if (before != nullptr && is_end_of_practice_said(*before, block)) {
      screens.push_back({"the practice is over", 1, feedback_s});
    }
    before = &block;
    add_trials(protocol, block, screens);
    add_forms(protocol, block.forms_after, screens);
  }
  add_forms(protocol, protocol.forms_after, screens);
  return screens;
}
}  // namespace tapstudy::runner
