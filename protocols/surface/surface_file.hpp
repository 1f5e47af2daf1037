#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "core/geometry/triangle_surface.hpp"
namespace tapstudy::protocols {
// What a surface's file has in excess of the body, which its reading drops.
struct SurfaceNoise {
  int points{};                  // that differ by noise from others, which take their places
  double farthest{};             // of them from the others, as a share of the surface's size
  int without_area{};            // triangles with two corners in one point
  std::string describe() const;  // empty: there is nothing
};

// The complete contents of a surface file: stored with the study that uses it.
struct SurfaceSource {
  std::string file;  // as the protocol names it
  std::string bytes;
  std::string sha256;    // of the bytes
  SurfaceNoise noise{};  // once it was read
  // Of a surface that a repair made of a file, what it changed (repaired_surface.hpp).
  std::vector<std::string> changes{};
};

struct ReadSurface {
  core::TriangleSurface surface;
  SurfaceNoise noise;
};

// The bytes of a file that a protocol names. Throws InvalidInput if there is none.
using ReadFile = std::function<std::string(const std::string& file)>;
// From where the surfaces of a protocol come.
struct SurfaceFiles {
  ReadFile contents;
  // Of a study that has begun: the bytes of its repaired surfaces, by their names. Unset: they are
  // made of the contents.
  ReadFile repaired{};
};
inline constexpr std::size_t max_surface_bytes = 200'000'000;

SurfaceSource surface_source(std::string file, std::string bytes);

// Reads the triangles of an STL (ASCII or binary), PLY, OFF or OBJ file, chosen by file extension;
// polygons are triangulated, concave ones included, points as near as noise are one. Coordinates
// are taken as decimal numbers and multiplied by metres_per_unit as such; points and triangles come
// in the order of their coordinates: the same surface gives the same numbers whatever its format,
// its unit and its order. Throws InvalidInput for other formats, with what converts them, for a
// file that is not of its format, and if a face cannot be triangulated.
ReadSurface read_surface(const SurfaceSource& source, double metres_per_unit);
}  // namespace tapstudy::protocols
