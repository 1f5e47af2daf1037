#pragma once
#include <set>
#include <string>

#include "device/loop/haptic_loop.hpp"
#include "protocols/protocol.hpp"
#include "protocols/rig.hpp"
namespace tapstudy::runner {
// Rigs for all known devices: see protocols/reader/read_rig.hpp.
protocols::Rig parse_rig(const std::string& text, const std::string& file);
// Throws InvalidInput also if the file cannot be read.
protocols::Rig read_rig(const std::string& file);
std::string rig_schema();
std::string calibration_schema();
std::set<std::string> rig_keys_asked_for(const std::string& text, const std::string& file);
// The rig of a study without hardware: the simulated hand, 10 N.
protocols::Rig simulated_rig();

// The loop settings for this protocol on this rig. Throws InvalidInput if they are incompatible.
device::LoopSettings loop_settings(const protocols::Protocol& protocol, const protocols::Rig& rig);
// Throws InvalidInput if a tapping point is outside the device's workspace, if the device's own
// section is implausible, or if its card cannot play the masking noise.
void check_fits(const protocols::Protocol& protocol, const protocols::Rig& rig);
}  // namespace tapstudy::runner
