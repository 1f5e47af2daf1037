#pragma once
#include <string>

#include "runner/terminal/session_lock.hpp"
namespace tapstudy::runner {
// Held by the program that adds to what a participant has done in a study.
class ParticipantLock {
 public:
  // Throws InvalidInput if a session of the participant is running.
  ParticipantLock(const std::string& directory, const std::string& participant_id);

 private:
  SessionLock lock_;
};
// Whether a session of the participant is running.
bool is_in_session(const std::string& directory, const std::string& participant_id);
}  // namespace tapstudy::runner
