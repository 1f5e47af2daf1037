#pragma once
#include "core/geometry/triangle_surface.hpp"
namespace tapstudy::protocols {
// Checks that a surface is a closed, consistently oriented, connected 2-manifold without
// self-intersections: finite points, non-degenerate triangles, every edge shared by two triangles
// in opposite directions, normals outward, one shell, no intersecting or overlapping triangles,
// between a millimetre and ten metres wide.
// Throws InvalidInput stating which condition is violated, and where.
void check_surface(const core::TriangleSurface& surface);
}  // namespace tapstudy::protocols
