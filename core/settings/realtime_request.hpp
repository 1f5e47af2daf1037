#pragma once
#include <optional>
namespace tapstudy::core {
// What is asked of the machine so that the haptic loop wakes in time. All of it may be refused.
struct RealtimeRequest {
  int fifo_priority{80};  // SCHED_FIFO, and that no processor sleeps deeply; 0: not asked for
  bool lock_memory{true};
  std::optional<int> cpu{};  // to stay on
};
}  // namespace tapstudy::core
