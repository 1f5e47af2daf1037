#pragma once
#include <string>

#include "core/settings/device_settings.hpp"
namespace tapstudy::device {
// Requests real-time scheduling for the calling thread, and locked memory for the whole process.
// Returns what was granted and what was refused as text for the record.
std::string ask_for_realtime(const core::RealtimeRequest& request);
}  // namespace tapstudy::device
