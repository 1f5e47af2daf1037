#pragma once
#include <string>

#include "core/settings/realtime_request.hpp"
namespace tapstudy::device {
// Asks the machine for the calling thread, and for the memory of the whole process. Returns in
// words what was granted and what was refused, for the record.
std::string ask_for_realtime(const core::RealtimeRequest& request);
}  // namespace tapstudy::device
