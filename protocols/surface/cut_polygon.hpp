#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "core/haptics/haptic_state.hpp"
namespace tapstudy::protocols {
// A face of any number of corners as triangles that have no other corners, wound as the face is:
// the constrained Delaunay triangulation of its outline (Chew 1989), seen along the axis that its
// normal is nearest to, so that concave faces are cut inside themselves. Empty if the outline, seen
// so, crosses or touches itself. Coordinates finite.
std::vector<std::array<std::size_t, 3>> cut_polygon(const std::vector<core::Vec3>& corners);
}  // namespace tapstudy::protocols
