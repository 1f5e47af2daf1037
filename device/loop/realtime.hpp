#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "core/settings/device_settings.hpp"
namespace tapstudy::device {
struct GrantedRealtime {
  struct Refusal {
    std::string what;
    std::string remedy;  // a command, or a key of the rig
  };
  std::string text;  // what was granted and what was refused, for the record
  std::vector<Refusal> refusals;
};
// Requests real-time scheduling for the calling thread, and locked memory for the whole process.
GrantedRealtime ask_for_realtime(const core::RealtimeRequest& request);
// For a thread that plays sound beside the loop: the loop comes first.
inline core::RealtimeRequest below(const core::RealtimeRequest& loop) {
  return {std::max(0, loop.fifo_priority - 1), loop.lock_memory, std::nullopt};
}
}  // namespace tapstudy::device
