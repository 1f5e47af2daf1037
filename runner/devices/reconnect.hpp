#pragma once
#include <memory>
#include <string>

#include "runner/devices/device_kind.hpp"
namespace tapstudy::runner {
// Tells the operator what ended the trial, waits until the device has been checked, and reopens it.
// Throws DeviceError if the operator chooses to stop, or if there is no hardware to check.
std::unique_ptr<SessionDevice> reconnect(const std::string& what_happened,
                                         const DeviceRequest& request,
                                         std::unique_ptr<SessionDevice> broken);
}  // namespace tapstudy::runner
