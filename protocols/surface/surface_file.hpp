#pragma once
#include <cstddef>
#include <functional>
#include <string>

#include "core/geometry/triangle_surface.hpp"
namespace tapstudy::protocols {
// The complete contents of a surface file: stored with the study that uses it.
struct SurfaceSource {
  std::string file;  // as the protocol names it
  std::string bytes;
  std::string sha256;  // of the bytes
};

// The bytes of a file that a protocol names. Throws InvalidInput if there is none.
using ReadFile = std::function<std::string(const std::string& file)>;
inline constexpr std::size_t max_surface_bytes = 200'000'000;

SurfaceSource surface_source(std::string file, std::string bytes);

// Reads the triangles of an STL (ASCII or binary), PLY, OFF or OBJ file, chosen by file extension;
// lengths are multiplied by metres_per_unit, coincident points merged, polygons triangulated,
// concave ones included. Throws InvalidInput for other formats, or if a face cannot be
// triangulated.
core::TriangleSurface read_surface(const SurfaceSource& source, double metres_per_unit);
}  // namespace tapstudy::protocols
