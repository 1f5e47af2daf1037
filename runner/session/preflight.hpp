#pragma once
#include <string>

#include "protocols/rig.hpp"
#include "runner/devices/diagnosis.hpp"
#include "runner/devices/session_device.hpp"
namespace tapstudy::runner {
// Real-time performance, measured before a session's first trial and stored with it.
struct PreflightReport {
  std::string device;
  Diagnosis diagnosis;
};
// Takes half a second. Warns if the machine or the device is too slow for the loop. `sleep` is the
// outcome of asking the system not to sleep, if it was asked.
PreflightReport run_preflight(const protocols::Rig& rig, SessionDevice& device,
                              device::Nanoseconds period, const std::string& sleep);
}  // namespace tapstudy::runner
