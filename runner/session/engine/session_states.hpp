#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "results/rows.hpp"
namespace tapstudy::runner {
// What a session is doing. The names are those of the store.
enum class SessionState {
  begun,
  instructions,
  resting,
  form,        // a questionnaire is asked
  ready,       // the trial is shown, nothing is rendered
  exploring,   // go: the plate is rendered
  answering,   // an answer is entered, changed or withdrawn; the plate is still rendered
  confirmed,   // the answer counts, and is changed only by a correction from now on
  confidence,  // the answer is given, force is off
  saved,
  repeated,   // stored, but presented again
  timed_out,  // likewise, or given up
  skipped,    // stored without an answer: at the operator's request
  paused,     // by the operator; a running trial is stored and presented again
  feedback,
  practised,  // a practice block is over, its criterion met or not
  faulted,
  stopped,
  ended
};
std::string_view name(SessionState state);
bool may_follow(SessionState before, SessionState after);

// The state of one session and the record of its changes, with the times of a monotonic clock.
class SessionStates {
 public:
  using Now = std::function<double()>;  // [s], from the session's begin
  // Told of each change as it happens, the session's begin included.
  using Listener = std::function<void(const results::SessionEventRow&)>;
  SessionStates(std::int64_t session_id, Now now_s, Listener listener = {});
  // Throws std::logic_error if the state may not follow the present one.
  void enter(SessionState state, std::optional<int> trial = {}, std::string detail = {});
  std::int64_t session_id() const { return session_id_; }
  double now_s() const { return now_s_(); }
  // The same without the time in which it was paused: what says how long trials take.
  double unpaused_s() const;
  SessionState state() const { return state_; }
  // The changes since the last call.
  std::vector<results::SessionEventRow> take_events();

 private:
  void note(std::optional<int> trial, std::string detail);

  std::int64_t session_id_;
  Now now_s_;
  Listener listener_;
  SessionState state_{SessionState::begun};
  double paused_s_{0.0};  // in pauses that are over
  double entered_at_s_{0.0};
  std::vector<results::SessionEventRow> events_;
};
}  // namespace tapstudy::runner
