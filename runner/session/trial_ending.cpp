#include "runner/session/trial_ending.hpp"
namespace tapstudy::runner {
std::optional<SessionState> state_of(TrialEnding ending) {
  switch (ending) {
    case TrialEnding::answered:
      return SessionState::saved;
    case TrialEnding::repeated:
      return SessionState::repeated;
    case TrialEnding::timed_out:
      return SessionState::timed_out;
    case TrialEnding::skipped:
      return SessionState::skipped;
    case TrialEnding::paused:
      return SessionState::paused;
    case TrialEnding::faulted:
      return SessionState::faulted;
    case TrialEnding::interrupted:
      break;
  }
  return std::nullopt;
}

results::TrialStatus status_of(TrialEnding ending, bool is_answered) {
  using results::TrialStatus;
  switch (ending) {
    case TrialEnding::answered:
      return TrialStatus::answered;
    case TrialEnding::repeated:
      return TrialStatus::repeated;
    case TrialEnding::timed_out:
      return TrialStatus::timed_out;
    case TrialEnding::skipped:
      return TrialStatus::skipped;
    case TrialEnding::faulted:
      return is_answered ? TrialStatus::answered : TrialStatus::interrupted;
    case TrialEnding::paused:
    case TrialEnding::interrupted:
      break;
  }
  return TrialStatus::interrupted;
}
}  // namespace tapstudy::runner
