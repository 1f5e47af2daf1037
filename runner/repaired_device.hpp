#pragma once
#include <memory>

#include "runner/session_device.hpp"
#include "runner/trial_engine.hpp"
namespace tapstudy::runner {
// Tells the operator what ended the trial, waits until the device is seen to, and opens it anew.
// Throws DeviceError if the operator would rather stop, or if there is nothing to see to.
std::unique_ptr<SessionDevice> repaired_device(const Interruption& interruption,
                                               const protocols::Rig& rig, double dt_s,
                                               LineInput& operator_input,
                                               std::unique_ptr<SessionDevice> broken);
}  // namespace tapstudy::runner
