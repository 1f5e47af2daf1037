#pragma once
#include <memory>
#include <string>

#include "core/settings/actuator_settings.hpp"
#include "device/audio/actuator_player.hpp"
#include "protocols/protocol.hpp"
#include "protocols/rig.hpp"
namespace tapstudy::runner {
// Throws InvalidInput where the protocol's crossover leaves vibration to an actuator that a
// participant's rig does not have, or that plays too few samples a second for the protocol's band.
void check_actuator(const protocols::Protocol& protocol, const protocols::Rig& rig);

// The actuator that renders what the protocol's crossover leaves to it; nullptr: none does.
const core::ActuatorOutput* actuator_of(const protocols::Protocol& protocol,
                                        const protocols::Rig& rig);

// Opens its card. Throws DeviceError where that cannot be had, or has a longer delay than the rig
// allows.
std::unique_ptr<device::PcmSink> open_actuator_card(const core::ActuatorOutput& actuator);
// A player on it. Throws likewise.
std::unique_ptr<device::ActuatorPlayer> actuator_player(const core::ActuatorOutput& actuator,
                                                        const protocols::Protocol& protocol,
                                                        const protocols::Rig& rig);
}  // namespace tapstudy::runner
