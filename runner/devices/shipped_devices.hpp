#pragma once
#include "runner/devices/device_kind.hpp"
namespace tapstudy::runner {
// A hand that taps by itself, on points drawn from the session's seed.
const DeviceKind& simulated_hand();
// A SPIDAR-G6 on the USB. The operator is asked to hold its grip in the middle before the first
// trial.
const DeviceKind& spidar_g6();
// A device that another program on this machine drives.
const DeviceKind& remote_device();
// The hand of a stored trial once more.
const DeviceKind& replayed_hand();
}  // namespace tapstudy::runner
