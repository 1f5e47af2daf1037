#pragma once
#include <optional>
#include <string>
#include <vector>

#include "runner/session/participants/participant.hpp"
namespace tapstudy::runner {
// What a person at the terminal types in a trial.
std::string upper_case_without_spaces(const std::string& line);

// An answer as the trial takes it: "= B" where people see labels to switch among and choose one of
// them, "=" where they set one, as it is set; else what protocols::answer_in takes.
std::optional<std::string> answer_typed(const std::string& line, const TrialPrompt& prompt,
                                        const Exploration& exploration);

// "+++" is 3 settings up, "-" one down.
std::optional<int> settings_moved(const std::string& line);

// How answers are given, to follow the labels that can be felt; and the same where what was typed
// is none.
std::string how_to_answer(const TrialPrompt& prompt);
std::string expected_among_alternatives(const TrialPrompt& prompt);

// Alternatives that come one after the other, as a person at the terminal is told of them.
class TypedIntervals {
 public:
  explicit TypedIntervals(const TrialPrompt& prompt)
      : labels_{prompt.alternative_labels},
        is_scripted_{prompt.block->explore.scripted_taps.has_value()} {}
  // Says what has changed since the last call: go signals, ends, the end of all.
  void announce(const Exploration& exploration);

 private:
  std::vector<std::string> labels_;
  bool is_scripted_;
  std::optional<IntervalState> told_;
};

// How they are presented; empty: they do not come one after the other.
std::string how_they_come(const TrialPrompt& prompt);
// "again": whether the line was that, and is dealt with.
bool replays(const std::string& line, Exploration& exploration);
}  // namespace tapstudy::runner
