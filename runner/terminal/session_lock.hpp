#pragma once
#include <string>
namespace tapstudy::runner {
// Held by one process of this machine at a time, and by none once it has ended, however it ended.
class SessionLock {
 public:
  // Throws InvalidInput with `refusal` if another process holds the same.
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
