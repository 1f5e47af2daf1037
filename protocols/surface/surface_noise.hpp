#pragma once
#include <string>

#include "protocols/surface/surface_file.hpp"
namespace tapstudy::protocols {
// What a surface's file has in excess of the body, which read_surface drops.
struct SurfaceNoise {
  int points{};                  // that differ by noise from others, which take their places
  double farthest{};             // of them from the others, as a share of the surface's size
  int without_area{};            // triangles with two corners in one point
  std::string describe() const;  // empty: there is nothing
};

// Of a file that read_surface reads.
SurfaceNoise noise_of(const SurfaceSource& source);
}  // namespace tapstudy::protocols
