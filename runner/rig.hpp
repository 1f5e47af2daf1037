#pragma once
#include "device/haptic_loop.hpp"
#include "device/simulated_hand.hpp"
#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// From what the YAML files say to what the device layer takes. Throws InvalidInput if they do not
// go together.
device::LoopSettings loop_settings(const protocols::Protocol& protocol, const protocols::Rig& rig);
device::HandBody hand_body(const protocols::SimulatedHandSettings& hand);
}  // namespace tapstudy::runner
