#include "runner/session/participants/trial_control.hpp"

#include <algorithm>
namespace tapstudy::runner {
namespace {
constexpr double interval_step_s = 0.01;  // an interval is so late at most in virtual time
}  // namespace

TrialControl::TrialControl(Exploration& loop, TrialRules rules, TrialEvents& events,
                           TrialLinks links)
    : loop_{loop}, rules_{std::move(rules)}, events_{events}, links_{std::move(links)} {
  if (rules_.settings) {
    setting_ = rules_.settings->start;
    note_setting();
  }
  if (rules_.limits.intervals) {
    loop_.request_silence(true);
    sequence_.emplace(rules_, time_s());
    render(sequence_->alternative());  // in silence
  }
}

bool TrialControl::poll() {
  take_requests();
  return is_loop_running() && !ended_by_operator_ && !is_time_over();
}

bool TrialControl::is_loop_running() {
  follow_intervals();
  return loop_.is_running();
}

void TrialControl::take_requests() {
  const OperatorRequests requests =
      links_.take_requests ? links_.take_requests() : OperatorRequests{};
  if (requests.switch_to) {
    switch_to(*requests.switch_to);
  }
  if (std::exchange(told_, current_) != current_ && links_.alternative_is_selected) {
    links_.alternative_is_selected(told_);
  }
  if (!ended_by_operator_ && requests.is_end_wanted()) {
    ended_by_operator_ = requests;
  }
}

void TrialControl::follow_intervals() {
  if (!sequence_) {
    return;
  }
  const std::size_t alternative = sequence_->alternative();
  const double now_s = time_s();
  switch (sequence_->advance({now_s, loop_.is_as_requested(), contacts(alternative)})) {
    case IntervalSequence::Step::none:
      return;
    case IntervalSequence::Step::opened:
      loop_.request_silence(false);
      events_.add({now_s, "interval", static_cast<double>(alternative)});
      return;
    case IntervalSequence::Step::closed:
      loop_.request_silence(true);
      events_.add({now_s, "interval_end", static_cast<double>(alternative)});
      if (sequence_->state().phase != IntervalState::Phase::over) {
        render(sequence_->alternative());
      }
  }
}

void TrialControl::pass_time(double seconds) {
  const double all_s = rules_.seconds_left_of(seconds, time_s());
  if (!sequence_) {
    loop_.pass_time(all_s);
    return;
  }
  const double until_s = time_s() + all_s;
  double before_s = time_s();
  double now_s = before_s;
  do {
    before_s = now_s;
    loop_.pass_time(std::min(until_s - before_s, interval_step_s));
    now_s = time_s();  // a step shorter than a tick does not pass in virtual time
  } while (is_loop_running() && now_s > before_s && now_s < until_s);
}

void TrialControl::switch_to(std::size_t alternative) {
  if (!sequence_) {
    render(alternative);
  }
}

void TrialControl::render(std::size_t alternative) {
  current_ = std::min(alternative, rules_.last());
  loop_.request_position(rules_.position_of(current_, setting_));
}

void TrialControl::adjust(std::size_t setting) {
  if (rules_.settings && setting < rules_.settings->values.size()) {
    if (std::exchange(setting_, setting) != setting) {
      note_setting();
    }
    render(rules_.last());
  }
}

// The setting that a trial starts at is an event, too.
void TrialControl::note_setting() {
  events_.add({time_s(), "setting", rules_.settings->values[setting_].begin()->second});
}

void TrialControl::replay() {
  if (!sequence_) {
    return;
  }
  const double now_s = time_s();
  if (const auto number = sequence_->replay(now_s)) {
    events_.add({now_s, "interval_replay", static_cast<double>(*number)});
    render(sequence_->alternative());
  }
}

void TrialControl::enter_answer(const std::string& answer) {
  if (std::exchange(entered_, answer) != answer && links_.answer_is_entered) {
    links_.answer_is_entered(answer);
  }
}

int TrialControl::contacts(std::size_t alternative) const {
  return loop_.contacts(rules_.position_of(alternative, setting_));
}

Explored TrialControl::explored() const {
  Explored so_far{
      time_s(), {}, !sequence_ || sequence_->state().phase == IntervalState::Phase::over};
  for (std::size_t i = 0; i < rules_.alternatives; ++i) {
    so_far.contacts.push_back(contacts(i));
  }
  return so_far;
}
}  // namespace tapstudy::runner
