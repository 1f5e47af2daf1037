#pragma once
#include <vector>

#include "core/placement.hpp"
#include "core/rng.hpp"
#include "device/hand/tap_path.hpp"
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
}  // namespace tapstudy::runner
