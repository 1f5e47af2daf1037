#pragma once
#include "device/haptic_loop.hpp"
#include "device/realtime.hpp"
#include "device/simulated_hand.hpp"
#include "device/spidar/spidar_g6.hpp"
#include "protocols/protocol.hpp"
#include "protocols/rig.hpp"
namespace tapstudy::runner {
// From what the YAML files say to what the device layer takes. Throws InvalidInput if they do not
// go together.
device::LoopSettings loop_settings(const protocols::Protocol& protocol, const protocols::Rig& rig);
// Throws InvalidInput if a tapping point lies where the rig's device cannot go, taps included, or
// if its calibration cannot be true: motors of one kind that differ by more than threefold, or a
// largest tension that takes more digits than the board has.
void check_fits(const protocols::Protocol& protocol, const protocols::Rig& rig);
// Of a rig that has a SPIDAR.
device::SpidarSettings spidar_settings(const protocols::SpidarRig& rig, double dt_s);
device::RealtimeRequest realtime_request(const protocols::LoopRig& rig);
device::HandBody hand_body(const protocols::SimulatedHandSettings& hand);
}  // namespace tapstudy::runner
