#pragma once
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
}  // namespace tapstudy::device
