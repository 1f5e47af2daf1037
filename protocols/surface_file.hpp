#pragma once
#include <string>

#include "core/geometry/triangle_surface.hpp"
namespace tapstudy::protocols {
// The triangles of an STL (ASCII or binary), PLY, OFF or OBJ file, lengths multiplied by
// metres_per_unit, points at one and the same place joined, larger faces cut into triangles.
// Throws InvalidInput if the file cannot be read or is none of these.
core::TriangleSurface read_surface(const std::string& file, double metres_per_unit);
}  // namespace tapstudy::protocols
