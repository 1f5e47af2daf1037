#include "runner/participants/typed_intervals.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "runner/participants/typed_answers.hpp"
#include "runner/terminal/say.hpp"
namespace tapstudy::runner {
using Phase = IntervalState::Phase;

void TypedIntervals::announce(const Exploration& exploration) {
  const IntervalState* const state = exploration.intervals();
  if (state == nullptr || told_ == *state) {
    return;
  }
  if (state->phase == Phase::leaving) {
    say("\n  lift your finger\n> ");
  } else if (state->phase == Phase::open) {
    say("\n  now {}{}\n> ", labels_.at(exploration.current()), is_scripted_ ? "" : ": tap it");
  } else if (told_ && told_->phase == Phase::open) {
    say("\n  stop{}\n> ",
        state->phase != Phase::over ? "; the next one follows"
        : state->replays_left > 0
            ? fmt::format("; your answer, or again (left: {})", state->replays_left)
            : "; your answer");
  }
  told_ = *state;
}

std::string how_they_come(const TrialPrompt& prompt) {
  const auto& intervals = prompt.block->explore.intervals;
  if (!intervals) {
    return "";
  }
  return fmt::format(
      "  {} come one after the other, for {:.3g} s each{}.{}",
      fmt::join(prompt.alternative_labels, ", "), intervals->seconds,
      prompt.block->explore.scripted_taps ? "" : ": tap each as soon as you are told",
      intervals->max_replays > 0 ? "   again: all of them once more." : "");
}

bool replays(const std::string& line, Exploration& exploration) {
  const IntervalState* const state = exploration.intervals();
  if (state == nullptr || upper_case_without_spaces(line) != "AGAIN") {
    return false;
  }
  if (state->phase != Phase::over) {
    say("  they are not over yet\n");
  } else if (state->replays_left == 0) {
    say("  they do not come again: please answer\n");
  }
  exploration.replay();
  return true;
}
}  // namespace tapstudy::runner
