#include "runner/commands/check_screens.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "protocols/procedures/simulated_length.hpp"
#include "protocols/schedule/groups.hpp"
#include "protocols/schedule/schedule.hpp"
#include "runner/console/scenes.hpp"
#include "runner/session/engine/between_trials.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/studies/counted.hpp"
namespace tapstudy::runner {
namespace {
// Of a procedure that may end early, by simulated people.
BlockLength length_of(const protocols::Protocol& protocol, const protocols::Block& block) {
  const int limit = protocols::planned_trials(block);
  if (!protocols::may_procedures_end_early(block)) {
    return {limit, limit, limit};
  }
  const protocols::Comparison& comparison = *block.comparison;
  const bool starts_from_0 =
      comparison.side == protocols::Side::either || block.task->has_own_guess_rate();
  const double guess_rate = starts_from_0 ? 0.0 : block.task->guess_rate(block, protocol);
  std::size_t usual = 0;
  std::size_t most = 0;
  std::size_t all = 0;
  for (const auto& track : comparison.tracks) {
    const protocols::TrackLength length = protocols::simulated_length(*track, guess_rate);
    usual += length.usual;
    most += length.most;
    all += track->max_trials();
  }
  // Trials between those of the procedures, such as equal pairs, are in proportion.
  const auto scaled = [&](std::size_t trials) {
    return static_cast<int>(std::lround(static_cast<double>(limit) * static_cast<double>(trials) /
                                        static_cast<double>(all)));
  };
  return {scaled(usual), scaled(most), limit};
}

}  // namespace

BlockLengths lengths_of(const protocols::Protocol& protocol) {
  BlockLengths lengths;
  for (const protocols::Block& block : protocol.blocks) {
    lengths[block.name] = length_of(protocol, block);
  }
  return lengths;
}

BlockLengths lengths_for(const protocols::Group* group, const protocols::Protocol& protocol,
                         BlockLengths lengths) {
  for (const protocols::Block& block : protocol.blocks) {
    if (group != nullptr && group->stimuli.contains(block.name)) {
      lengths[block.name] = length_of(protocol, protocols::block_of(group, block));
    }
  }
  return lengths;
}

std::string describe_length(const protocols::Block& block, const BlockLength& length) {
  const std::string limit = counted(static_cast<std::size_t>(length.limit), "trial");
  if (length.usual < length.limit) {
    return fmt::format("about {} (simulated; up to {} for 19 of 20 people, at most {})",
                       counted(static_cast<std::size_t>(length.usual), "trial"), length.most,
                       length.limit);
  }
  return (may_end_early(block) ? "at most " : "") + limit;
}

namespace {
struct ScreenGroup {
  std::string shown;  // description
  int count{};
  double seconds{};  // that all of them take, roughly; of trials without the tapping
};

// Rough durations of screens, from experience in laboratories: not measured.
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
std::vector<ScreenGroup> trial_screens(const protocols::Block& block, const BlockLength& length) {
  const int trials = length.usual;
  const bool is_mounted = block.presented == protocols::Presented::real_plates;
  std::vector<ScreenGroup> screens{
      {fmt::format("{}: {}", block.name, describe_length(block, length)), trials,
       trials * (decision_s + (is_mounted ? mounting_s : 0.0))}};
  if (block.confidence) {
    screens.push_back({fmt::format("confidence in {} steps, after each", block.confidence->steps),
                       trials, trials * confidence_s});
  }
  if (block.gives_feedback) {
    screens.push_back({"feedback, after each", trials, trials * feedback_s});
  }
  return screens;
}

// The number of breaks in a block of this duration without them; none follows the last trial.
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
                const BlockLength& length, std::vector<ScreenGroup>& screens) {
  const std::vector<ScreenGroup> own = trial_screens(block, length);
  screens.insert(screens.end(), own.begin(), own.end());
  if (block.breaks) {
    double block_s = length.usual * simulated_trial_s(protocol, block);
    for (const ScreenGroup& group : own) {
      block_s += group.seconds;
    }
    const int count = number_of(*block.breaks, length.usual, block_s);
    const double each_s = std::clamp(rest_s, block.breaks->min_seconds,
                                     block.breaks->max_seconds.value_or(max_rest_s));
    screens.push_back({described(*block.breaks), count, count * each_s});
  }
}
std::vector<ScreenGroup> screens_of(const protocols::Protocol& protocol,
                                    const protocols::Group* group, const BlockLengths& of_all) {
  const BlockLengths lengths = lengths_for(group, protocol, of_all);
  std::vector<ScreenGroup> screens;
  add_instructions(protocol.instructions, "the study", screens);
  add_forms(protocol, protocol.forms_before, screens);
  const protocols::Block* before = nullptr;
  for (const protocols::Block& block : protocol.blocks) {
    if (!protocols::does(group, block)) {
      continue;
    }
    add_instructions(block.instructions, block.name, screens);
    if (before != nullptr && is_end_of_practice_said(*before, block)) {
      screens.push_back({"the practice is over", 1, feedback_s});
    }
    before = &block;
    add_trials(protocol, block, lengths.at(block.name), screens);
    add_forms(protocol, block.forms_after, screens);
  }
  add_forms(protocol, protocol.forms_after, screens);
  return screens;
}

void warn_of_unasked_forms(const protocols::Protocol& protocol) {
  std::set<std::string> asked{protocol.forms_before.begin(), protocol.forms_before.end()};
  asked.insert(protocol.forms_after.begin(), protocol.forms_after.end());
  for (const protocols::Block& block : protocol.blocks) {
    asked.insert(block.forms_after.begin(), block.forms_after.end());
  }
  for (const auto& [name, form] : protocol.forms) {
    if (!asked.contains(name)) {
      fmt::print("  warning: forms.{} is never asked (forms_before, forms_after)\n", name);
    }
  }
}

// The picture would tell which plate it is.
void note_hidden_plates(const protocols::Protocol& protocol) {
  const Scenes scenes{protocol, protocol.placement};
  for (const protocols::Block& block : protocol.blocks) {
    if (protocol.display.shows_plate && block.presented == protocols::Presented::virtual_plates &&
        !scenes.number_of(block.stimuli.front(), block)) {
      fmt::print("  note: the page shows no plate in block {}: its plates look different\n",
                 block.name);
    }
  }
}

}  // namespace

double seconds_of_screens(const protocols::Protocol& protocol, const protocols::Group* group,
                          const BlockLengths& lengths) {
  double seconds = 0.0;
  for (const ScreenGroup& screens : screens_of(protocol, group, lengths)) {
    seconds += screens.seconds;
  }
  return seconds;
}

void print_screens(const protocols::Protocol& protocol, const BlockLengths& lengths) {
  for (const protocols::Group* const group : protocols::groups_of(protocol)) {
    fmt::print("\nscreens of a participant{}\n",
               group == nullptr ? "" : fmt::format(" of group {}", group->name));
    int total = 0;
    for (const ScreenGroup& screen : screens_of(protocol, group, lengths)) {
      fmt::print("  {:>4}  {}\n", screen.count, screen.shown);
      total += screen.count;
    }
    fmt::print("  {:>4}  in all, if no trial is repeated\n", total);
  }
  warn_of_unasked_forms(protocol);
  note_hidden_plates(protocol);
}
}  // namespace tapstudy::runner
