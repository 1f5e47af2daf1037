#pragma once
#include <optional>
#include <string>
namespace tapstudy::device {
// What is asked of the machine so that the loop wakes in time. All of it may be refused; what was
// got is told in words, for the record.
struct RealtimeRequest {
  int fifo_priority{80};  // SCHED_FIFO, and that no processor sleeps deeply; 0: not asked for
  bool lock_memory{true};
  std::optional<int> cpu;  // to stay on
};

// For the calling thread, and for the memory of the whole process.
std::string ask_for_realtime(const RealtimeRequest& request);
}  // namespace tapstudy::device
