#pragma once
#include <string>
namespace tapstudy::runner {
// A machine-wide inter-process lock, released whenever its process ends, for any reason.
class SessionLock {
 public:
  // Throws InvalidInput with `refusal` if another process holds the same lock.
  SessionLock(const std::string& what, const std::string& refusal);
  ~SessionLock();
  SessionLock(const SessionLock& other) = delete;
  SessionLock& operator=(const SessionLock& other) = delete;
  SessionLock(SessionLock&& other) = delete;
  SessionLock& operator=(SessionLock&& other) = delete;

 private:
  int socket_;
};

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
