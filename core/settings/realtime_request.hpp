#pragma once
#include <optional>
namespace tapstudy::core {
// Real-time facilities requested for the haptic loop. Any of them may be refused.
struct RealtimeRequest {
  int fifo_priority{80};  // SCHED_FIFO, and no deep CPU idle states; 0: not requested
  bool lock_memory{true};
  std::optional<int> cpu{};  // CPU affinity
};
}  // namespace tapstudy::core
