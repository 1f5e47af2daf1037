#pragma once
#include <string>

#include "core/geometry/triangle_surface.hpp"
#include "protocols/surface/surface_source.hpp"
namespace tapstudy::protocols {
SurfaceSource surface_source(std::string file, std::string bytes);

// Reads the triangles of an STL (ASCII or binary), PLY, OFF or OBJ file, chosen by file extension;
// lengths are multiplied by metres_per_unit, coincident points merged, polygons triangulated,
// concave ones included. Throws InvalidInput for other formats, or if a face cannot be
// triangulated.
core::TriangleSurface read_surface(const SurfaceSource& source, double metres_per_unit);
}  // namespace tapstudy::protocols
