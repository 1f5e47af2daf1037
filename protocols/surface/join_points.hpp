#pragma once
#include <cstddef>
#include <vector>

#include "core/haptics/haptic_state.hpp"
namespace tapstudy::protocols {
// Points that are no further apart than this share of a surface's size differ by noise of the
// program that wrote them: single precision rounds a coordinate by 6e-8 of it, and what several
// such roundings and a program's own arithmetic make of one corner in several triangles is up to
// some 4e-7 of the size. Details of a body are far larger.
inline constexpr double noise_of_size = 1e-6;

// The diagonal of the points' bounding box.
double size_of(const std::vector<core::Vec3>& points);

// Of each point the number of the one that takes its place, the first of those that differ from it
// by noise: its own where there are none. Points without gaps wider than noise between them are one
// if all of them fit into a box with a diagonal as long as that; a longer chain of points stays as
// it is. Points are distinct and in the order of their coordinates, so that the result does not
// depend on the order in which a file has them.
std::vector<std::size_t> without_noise(const std::vector<core::Vec3>& points,
                                       double share_of_size = noise_of_size);
}  // namespace tapstudy::protocols
