#pragma once
#include <functional>
#include <memory>
#include <string>

#include "device/loop/realtime.hpp"
#include "device/loop/tick_clock.hpp"
namespace tapstudy::device {
struct ProbedLoop {
  GrantedRealtime realtime;
  int timer_slack_ns{};  // of the loop's own thread
  LatenessCount lateness;
  std::int64_t late{0};  // by more than half a period
  LatenessCount work;    // how long each tick's work took
};

// Runs a periodic loop for the given time and records its lateness, in a separate thread that
// requests the same real-time facilities as the haptic thread. The loop is empty, or does this work
// in each tick, for example an exchange with a device. Rethrows what the work throws.
ProbedLoop probe_loop(const core::RealtimeRequest& request, Nanoseconds period, double seconds,
                      const std::function<void()>& work = {});

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
