#pragma once
#include <optional>
#include <string>

#include "core/haptics/haptic_state.hpp"
#include "protocols/schedule/schedule.hpp"
#include "results/rows.hpp"
#include "runner/session/engine/session_states.hpp"
#include "runner/session/trial_loop/trial_loop.hpp"
namespace tapstudy::runner {
enum class TrialEnding { answered, repeated, timed_out, skipped, paused, interrupted, faulted };

// The session's state after it; nullopt: it is about to be stopped.
std::optional<SessionState> state_of(TrialEnding ending);

// A fault after the answer does not take it back.
results::TrialStatus status_of(TrialEnding ending, bool is_answered);

// A trial ended by a fault, and stored. The fault may have occurred after the answer.
struct Interruption {
  int trial{};
  core::TickFault fault{};
  bool is_answered{};
  bool is_force_off{};  // confirmed by the device, to the loop or to its guardian
};
std::string to_text(const Interruption& interruption);

struct Answer {
  std::string response;  // as the task stores it
  double response_time_s{};
  std::optional<int> confidence{};
};
// A trial as the store takes it.
results::TrialRecord trial_record(std::int64_t session_id, const protocols::PlannedTrial& trial,
                                  const protocols::Block& block, int attempt,
                                  results::TrialStatus status, const std::optional<Answer>& answer,
                                  TrialResult result);
}  // namespace tapstudy::runner
