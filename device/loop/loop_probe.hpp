#pragma once
#include <memory>
#include <string>

#include "device/loop/lateness.hpp"
#include "device/loop/realtime.hpp"
namespace tapstudy::device {
struct ProbedLoop {
  std::string realtime;  // what was got of the machine
  int timer_slack_ns{};  // of the loop's own thread
  LatenessCount lateness;
  std::int64_t late{0};  // by more than half a period
};

// Wakes at a rate for so long, with nothing to do, and counts how late; in a thread of its own that
// asks for what the haptic thread asks for.
ProbedLoop probe_loop(const core::RealtimeRequest& request, Nanoseconds period, double seconds);

// Work for all processors and the disk, for as long as it lives.
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
