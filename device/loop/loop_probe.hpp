#pragma once
#include <memory>
#include <string>

#include "device/loop/lateness.hpp"
#include "device/loop/realtime.hpp"
namespace tapstudy::device {
struct ProbedLoop {
  std::string realtime;  // what the machine granted
  int timer_slack_ns{};  // of the loop's own thread
  LatenessCount lateness;
  std::int64_t late{0};  // by more than half a period
};

// Runs an empty periodic loop for the given time and records its lateness, in a separate thread
// that requests the same real-time facilities as the haptic thread.
ProbedLoop probe_loop(const core::RealtimeRequest& request, Nanoseconds period, double seconds);

// Loads all processors and the disk during its lifetime.
class Load {
 public:
  Load();
  ~Load();
  Load(const Load& other) = delete;
  Load& operator=(const Load& other) = delete;
  Load(Load&& other) = delete;
  Load& operator=(Load&& other) = delete;

 private:
  struct Workers;
  std::unique_ptr<Workers> workers_;
};
}  // namespace tapstudy::device
