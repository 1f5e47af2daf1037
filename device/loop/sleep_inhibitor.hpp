#pragma once
#include <string>
namespace tapstudy::device {
// While it lives, the system is asked not to sleep, by itself, on a closed lid or on request: with
// the processors off nobody takes force off a device. Asks logind over the system bus; where there
// is none, or it refuses, what happened is told for the record.
class SleepInhibitor {
 public:
  SleepInhibitor();
  ~SleepInhibitor();
  SleepInhibitor(const SleepInhibitor&) = delete;
  SleepInhibitor& operator=(const SleepInhibitor&) = delete;
  SleepInhibitor(SleepInhibitor&&) = delete;
  SleepInhibitor& operator=(SleepInhibitor&&) = delete;
  const std::string& outcome() const noexcept { return outcome_; }

 private:
  int lock_{-1};  // held as long as it is open
  std::string outcome_;
};
}  // namespace tapstudy::device
