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
}  // namespace tapstudy::runner
