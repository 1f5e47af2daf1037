#pragma once
#include <memory>
#include <string>

#include "runner/devices/device_kind.hpp"
namespace tapstudy::runner {
// Tells the operator what ended the trial, waits until the device is seen to, and opens it anew.
// Throws DeviceError if the operator would rather stop, or if there is nothing to see to.
std::unique_ptr<SessionDevice> reconnect(const std::string& what_happened,
                                         const DeviceRequest& request,
                                         std::unique_ptr<SessionDevice> broken);
}  // namespace tapstudy::runner
