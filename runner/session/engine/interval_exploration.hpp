#pragma once
#include <cstddef>
#include <vector>

#include "protocols/protocol.hpp"
#include "runner/session/engine/trial_record.hpp"
#include "runner/session/trial_loop/exploration.hpp"
namespace tapstudy::runner {
// An exploration whose alternatives come one after the other, each in an interval of its own; with
// nothing to feel in between. Nobody switches. Gaps and intervals last from when the finger is off
// the plate, so that what was asked of the loop is in effect. Each go signal is an event `interval`
// and each end an event `interval_end`, with the place of the alternative; each replay as
// `interval_replay`, with its number. Without intervals in the limits nothing is changed.
class IntervalExploration final : public ForwardedExploration {
 public:
  IntervalExploration(Exploration& inner, const protocols::ExploreLimits& limits,
                      std::size_t alternatives, TrialEvents& events);
  void switch_to(std::size_t alternative) override;
  const IntervalState* intervals() const override { return limits_.intervals ? &state_ : nullptr; }
  void replay() override;
  void pass_time(double seconds) override;
  // Called continually while anybody waits, so intervals begin and end here too.
  bool is_running() const override;

 private:
  void follow() const;
  void follow_gap() const;
  void follow_interval() const;
  bool is_in_effect(double seconds) const;
  void begin_gap(std::size_t next) const;
  void open() const;
  void close() const;

  const protocols::ExploreLimits& limits_;
  std::size_t alternatives_;
  TrialEvents& events_;
  mutable IntervalState state_;
  mutable std::size_t next_{0};       // or the one that is open
  mutable bool is_in_effect_{false};  // the gap's silence, or the interval's alternative
  mutable double until_s_{0.0};       // of the gap or the interval
  mutable int contacts_before_{0};
};
}  // namespace tapstudy::runner
