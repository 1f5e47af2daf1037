#pragma once
#include <optional>
#include <vector>

#include "core/haptics/haptic_state.hpp"
#include "core/random/rng.hpp"
#include "device/hand/hand_motion.hpp"
#include "device/hand/scripted_hand.hpp"
#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// A tapping point of the study on the plates' surfaces, in the plate frame at the placement's
// scale.
core::Vec3 point_on_surface_m(const protocols::Protocol& protocol, const std::string& point);

// The target points: the protocol's tapping points, in the device frame.
std::vector<core::Vec3> aims_m(const protocols::Protocol& protocol,
                               const core::Placement& placement);

// Random taps: every point once in random order, then again; position, speed and dwell time vary
// from tap to tap. All land on the plate.
std::vector<device::PlannedTap> draw_taps(const protocols::Protocol& protocol,
                                          const protocols::SimulatedTapSettings& settings,
                                          const core::Placement& placement, int count,
                                          core::Rng& rng);

// What taps in the participant's place: the simulated hand of the protocol. nullopt where the
// participant taps.
std::optional<device::RepeatedTap> scripted_tap(const protocols::Protocol& protocol,
                                                const std::optional<protocols::ScriptedTaps>& taps);
}  // namespace tapstudy::runner
