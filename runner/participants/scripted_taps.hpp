#pragma once
#include <optional>

#include "device/hand/scripted_hand.hpp"
#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// What taps in the participant's place: the simulated hand of the protocol. nullopt where the
// participant taps.
std::optional<device::RepeatedTap> scripted_tap(const protocols::Protocol& protocol,
                                                const std::optional<protocols::ScriptedTaps>& taps);
}  // namespace tapstudy::runner
