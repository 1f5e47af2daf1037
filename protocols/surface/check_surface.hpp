#pragma once
#include "core/geometry/triangle_surface.hpp"
namespace tapstudy::protocols {
// A surface encloses one body in one piece: finite points, triangles with an area, every edge
// shared by two triangles that run along it in opposite directions, normals outward, one shell, no
// triangle through or upon another, between a millimetre and ten metres wide.
// Throws InvalidInput saying which of these does not hold, and where.
void check_surface(const core::TriangleSurface& surface);
}  // namespace tapstudy::protocols
