#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "device/loop/haptic_loop.hpp"
#include "protocols/protocol.hpp"
#include "protocols/schedule/schedule.hpp"
#include "runner/session/participants/participant.hpp"
namespace tapstudy::runner {
// How the alternatives of one trial may be explored. Where the last alternative has settings, each
// of them is rendered by a position of the loop of its own, and these positions come last
// (protocols::rendered).
static_assert(protocols::max_settings < device::max_alternatives);
struct TrialRules {
  protocols::ExploreLimits limits{};
  std::size_t alternatives{1};
  std::optional<protocols::Settings> settings{};  // of the last alternative

  std::size_t last() const { return alternatives - 1; }
  std::size_t position_of(std::size_t alternative, std::size_t setting) const {
    return alternative < last() ? alternative : last() + setting;
  }
  bool is_time_over(double time_s) const {
    return limits.max_seconds && time_s >= *limits.max_seconds;
  }
  // The part of `seconds` that is left before the trial's time is over.
  double seconds_left_of(double seconds, double time_s) const;
};
TrialRules rules_of(const protocols::PlannedTrial& trial, const protocols::Block& block);

// A trial whose alternatives come one after the other is before one of them, in its interval, or
// behind the last. leaving: the gap has not begun, since the finger is still on the plate.
struct IntervalState {
  enum class Phase { gap, leaving, open, over };
  Phase phase{Phase::gap};
  int replays_left{};
  bool operator==(const IntervalState& other) const = default;
};

// Alternatives that come one after the other, each in an interval of its own, with nothing to feel
// in between. Gaps and intervals last from when the finger is off the plate, so that what was
// requested of the loop is in effect; an interval also lasts until its alternative was touched.
class IntervalSequence {
 public:
  // Begins with the first gap. Throws std::bad_optional_access without intervals in the rules.
  IntervalSequence(const TrialRules& rules, double time_s);
  struct Observation {
    double time_s{};
    bool is_as_requested{};
    int contacts{};  // so far, with alternative()
  };
  enum class Step { none, opened, closed };
  // Takes one step at most. opened: alternative() can be felt from now on; closed: it no longer
  // can, and alternative() is the next one unless all are over.
  Step advance(const Observation& seen);
  // All intervals once more, where the last is over and replays are left: the number of this
  // replay, from 1.
  std::optional<int> replay(double time_s);
  const IntervalState& state() const { return state_; }
  std::size_t alternative() const { return alternative_; }  // in its interval, or next

 private:
  void begin_gap(std::size_t next, double time_s);
  bool is_in_effect(double seconds, const Observation& seen);
  Step follow_gap(const Observation& seen);
  Step follow_interval(const Observation& seen);

  protocols::Intervals intervals_;
  int min_contacts_;
  std::size_t alternatives_;
  IntervalState state_;
  std::size_t alternative_{0};
  bool is_in_effect_{false};  // the gap's silence, or the interval's alternative
  double until_s_{0.0};       // the end of the gap or the interval
  int contacts_before_{0};
};

// The part of a trial so far that decides whether it may be answered.
struct Explored {
  double time_s{};
  std::vector<int> contacts{};  // with each alternative
  bool are_intervals_over{true};
};
// The reason why an answer given now would be too early; nullopt: it is not.
std::optional<TooEarly> too_early(const TrialPrompt& prompt, const std::string& answer,
                                  const Explored& explored);
}  // namespace tapstudy::runner
