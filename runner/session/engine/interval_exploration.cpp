#include "runner/session/engine/interval_exploration.hpp"

#include <algorithm>
namespace tapstudy::runner {
namespace {
using Phase = IntervalState::Phase;
constexpr double step_s = 0.01;  // how late an interval may begin or end in virtual time
}  // namespace

IntervalExploration::IntervalExploration(Exploration& inner, const protocols::ExploreLimits& limits,
                                         std::size_t alternatives, TrialEvents& events)
    : ForwardedExploration{inner}, limits_{limits}, alternatives_{alternatives}, events_{events} {
  if (limits_.intervals) {
    inner.silence(true);
    state_.replays_left = limits_.intervals->max_replays;
    begin_gap(0);
  }
}

void IntervalExploration::switch_to(std::size_t alternative) {
  if (!limits_.intervals) {
    inner().switch_to(alternative);
  }
}

void IntervalExploration::replay() {
  if (intervals() == nullptr || state_.phase != Phase::over || state_.replays_left == 0) {
    return;
  }
  --state_.replays_left;
  const int number = limits_.intervals->max_replays - state_.replays_left;
  events_.add({time_s(), "interval_replay", static_cast<double>(number)});
  begin_gap(0);
}

void IntervalExploration::pass_time(double seconds) {
  if (!limits_.intervals) {
    inner().pass_time(seconds);
    return;
  }
  const double until_s = time_s() + seconds;
  double before_s = time_s();
  double now_s = before_s;
  do {
    before_s = now_s;
    inner().pass_time(std::min(until_s - before_s, step_s));
    now_s = time_s();  // what is shorter than a tick does not pass in virtual time
  } while (is_running() && now_s > before_s && now_s < until_s);
}

bool IntervalExploration::is_running() const {
  if (limits_.intervals) {
    follow();
  }
  return inner().is_running();
}

void IntervalExploration::follow() const {
  switch (state_.phase) {
    case Phase::gap:
    case Phase::leaving:
      return follow_gap();
    case Phase::open:
      return follow_interval();
    case Phase::over:
      return;
  }
}

// What was asked of the loop is in effect from a moment without contact on; time counts from then.
bool IntervalExploration::is_in_effect(double seconds) const {
  if (!is_in_effect_ && inner().is_as_asked()) {
    is_in_effect_ = true;
    until_s_ = time_s() + seconds;
  }
  return is_in_effect_;
}

void IntervalExploration::follow_gap() const {
  if (is_in_effect(limits_.intervals->gap_seconds)) {
    state_.phase = Phase::gap;
    if (time_s() >= until_s_) {
      open();
    }
  } else if (time_s() >= until_s_) {
    state_.phase = Phase::leaving;
  }
}

void IntervalExploration::follow_interval() const {
  if (is_in_effect(limits_.intervals->seconds) && time_s() >= until_s_ &&
      inner().contacts(next_) - contacts_before_ >= limits_.min_contacts) {
    close();
  }
}

void IntervalExploration::begin_gap(std::size_t next) const {
  next_ = next;
  is_in_effect_ = false;
  until_s_ = time_s() + limits_.intervals->gap_seconds;
  state_.phase = Phase::gap;
  inner().switch_to(next);  // in silence
}

void IntervalExploration::open() const {
  is_in_effect_ = false;
  inner().silence(false);
  contacts_before_ = inner().contacts(next_);
  state_.phase = Phase::open;
  events_.add({time_s(), "interval", static_cast<double>(next_)});
}

void IntervalExploration::close() const {
  inner().silence(true);
  events_.add({time_s(), "interval_end", static_cast<double>(next_)});
  if (next_ + 1 < alternatives_) {
    begin_gap(next_ + 1);
  } else {
    state_.phase = Phase::over;
  }
}
}  // namespace tapstudy::runner
