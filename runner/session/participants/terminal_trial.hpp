#pragma once
#include <optional>
#include <string>
#include <vector>

#include "runner/session/participants/trial_control.hpp"
namespace tapstudy::runner {
// Lines that a person at the terminal types in a trial.
std::string upper_case_without_spaces(const std::string& line);

// An answer as the trial takes it: "= B" where people see labels to switch among and choose one of
// them, "=" where they set one, as it is set; else what protocols::answer_in takes.
std::optional<std::string> answer_typed(const std::string& line, const TrialPrompt& prompt,
                                        const TrialControl& control);

// "+++" is 3 settings up, "-" one down.
std::optional<int> settings_moved(const std::string& line);

// How answers are given, to follow the labels that can be felt; and the same where the typed line
// is no answer.
std::string answer_instructions(const TrialPrompt& prompt);
std::string expected_among_alternatives(const TrialPrompt& prompt);

// Alternatives that come one after the other, as a person at the terminal is told of them.
class TypedIntervals {
 public:
  explicit TypedIntervals(const TrialPrompt& prompt)
      : labels_{prompt.alternative_labels},
        is_scripted_{prompt.block->explore.scripted_taps.has_value()} {}
  // Says what has changed since the last call: go signals, ends, the end of all.
  void announce(const TrialControl& control);

 private:
  std::vector<std::string> labels_;
  bool is_scripted_;
  std::optional<IntervalState> told_;
};

// How long is left to answer, as a person at the terminal is told of it.
class TypedCountdown {
 public:
  explicit TypedCountdown(std::optional<double> limit_s) : limit_s_{limit_s} {}
  // The seconds that are to be said now: 30, 10 and 5, each once.
  std::optional<int> due(double time_s);

 private:
  std::optional<double> limit_s_;
  std::optional<int> said_;
};

// Empty: the alternatives do not come one after the other.
std::string interval_instructions(const TrialPrompt& prompt);
// Whether the line was "again", and is dealt with.
bool replays(const std::string& line, TrialControl& control);
}  // namespace tapstudy::runner
