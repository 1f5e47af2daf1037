#pragma once
#include <string>

#include "core/geometry/triangle_surface.hpp"
#include "protocols/surface/surface_source.hpp"
namespace tapstudy::protocols {
SurfaceSource surface_source(std::string file, std::string bytes);

// The triangles of an STL (ASCII or binary), PLY, OFF or OBJ file, by the ending of its name,
// lengths multiplied by metres_per_unit, points at one and the same place joined, larger faces cut
// into triangles, concave ones too. Throws InvalidInput if it is none of these, or if a face cannot
// be cut.
core::TriangleSurface read_surface(const SurfaceSource& source, double metres_per_unit);
}  // namespace tapstudy::protocols
