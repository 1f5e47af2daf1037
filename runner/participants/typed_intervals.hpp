#pragma once
#include <optional>
#include <string>
#include <vector>

#include "runner/participants/participant.hpp"
namespace tapstudy::runner {
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
