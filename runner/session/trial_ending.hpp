#pragma once
#include <optional>

#include "results/rows.hpp"
#include "runner/session/session_states.hpp"
namespace tapstudy::runner {
enum class TrialEnding { answered, repeated, timed_out, skipped, paused, interrupted, faulted };

// The session's state after it; nullopt: it is about to be stopped.
std::optional<SessionState> state_of(TrialEnding ending);

// A fault after the answer does not take it back.
results::TrialStatus status_of(TrialEnding ending, bool is_answered);
}  // namespace tapstudy::runner
