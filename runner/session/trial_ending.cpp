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

std::string status_of(TrialEnding ending, bool is_answered) {
  switch (ending) {
    case TrialEnding::answered:
      return "answered";
    case TrialEnding::repeated:
      return "repeated";
    case TrialEnding::timed_out:
      return "timed_out";
    case TrialEnding::skipped:
      return "skipped";
    case TrialEnding::faulted:
      return is_answered ? "answered" : "interrupted";
    case TrialEnding::paused:
    case TrialEnding::interrupted:
      break;
  }
  return "interrupted";
}
}  // namespace tapstudy::runner
