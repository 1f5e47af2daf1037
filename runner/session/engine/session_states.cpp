#include "runner/session/engine/session_states.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>
namespace tapstudy::runner {
namespace {
using enum SessionState;
struct Row {
  SessionState state;
  std::string_view name;
  std::vector<SessionState> next;
};

// Between two trials anything may come that is not part of one.
const std::vector<SessionState>& between_trials() {
  static const std::vector<SessionState> states{instructions, resting,   form,    ready,
                                                paused,       practised, stopped, ended};
  return states;
}
// While a plate is rendered: what an answer goes through, and how a trial ends without one.
const std::vector<SessionState>& while_exploring() {
  static const std::vector<SessionState> states{answering, confirmed, repeated, timed_out,
                                                skipped,   paused,    faulted,  stopped};
  return states;
}
std::vector<SessionState> between_trials_or(SessionState one, SessionState other) {
  std::vector<SessionState> states = between_trials();
  states.insert(states.end(), {one, other});
  return states;
}

const std::array<Row, 19>& table() {
  static const std::array<Row, 19> rows{
      {{begun, "begun", between_trials()},
       {instructions, "instructions", between_trials()},
       {resting, "resting", between_trials()},
       {form, "form", between_trials()},
       {ready, "ready", {exploring, stopped}},
       {exploring, "exploring", while_exploring()},
       {answering, "answering", while_exploring()},
       {confirmed, "confirmed", {confidence, saved, repeated, faulted, stopped}},
       {confidence, "confidence", {saved, repeated, faulted, stopped}},
       {saved, "saved", between_trials_or(feedback, faulted)},
       {repeated, "repeated", {ready, paused, stopped}},
       {timed_out, "timed_out", between_trials()},
       {skipped, "skipped", between_trials()},
       {paused, "paused", between_trials()},
       {feedback, "feedback", between_trials()},
       {practised, "practised", between_trials()},
       {faulted, "faulted", between_trials()},
       {stopped, "stopped", {}},
       {ended, "ended", {}}}};
  return rows;
}
const Row& row_of(SessionState state) {
  return *std::ranges::find(table(), state, &Row::state);
}
}  // namespace

std::string_view name(SessionState state) {
  return row_of(state).name;
}

bool may_follow(SessionState before, SessionState after) {
  return std::ranges::find(row_of(before).next, after) != row_of(before).next.end();
}

SessionStates::SessionStates(std::int64_t session_id, Now now_s, Listener listener)
    : session_id_{session_id}, now_s_{std::move(now_s)}, listener_{std::move(listener)} {
  note({}, {});
}

void SessionStates::note(std::optional<int> trial, std::string detail) {
  events_.push_back({session_id_, now_s_(), std::string{name(state_)}, trial, std::move(detail)});
  if (listener_) {
    listener_(results::SessionEventRow{events_.back()});  // it may take all of them away
  }
}

void SessionStates::enter(SessionState state, std::optional<int> trial, std::string detail) {
  if (!may_follow(state_, state)) {
    throw std::logic_error{
        fmt::format("a session that is {} cannot become {}", name(state_), name(state))};
  }
  paused_s_ = now_s_() - unpaused_s();
  entered_at_s_ = now_s_();
  state_ = state;
  note(trial, std::move(detail));
}

double SessionStates::unpaused_s() const {
  return (state_ == SessionState::paused ? entered_at_s_ : now_s_()) - paused_s_;
}

std::vector<results::SessionEventRow> SessionStates::take_events() {
  return std::exchange(events_, {});
}
}  // namespace tapstudy::runner
