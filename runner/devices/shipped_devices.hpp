#pragma once
#include "runner/devices/device_kind.hpp"
namespace tapstudy::runner {
// A simulated hand that taps points drawn from the session's seed.
const DeviceKind& simulated_hand();
// A SPIDAR-G6 on the USB. The operator is asked to hold its grip in the middle before the first
// trial.
const DeviceKind& spidar_g6();
// A device that another program on this machine drives.
const DeviceKind& remote_device();
// Replays the hand of a stored trial.
const DeviceKind& replayed_hand();
}  // namespace tapstudy::runner
