#pragma once
#include <array>

#include "core/geometry/triangle_surface.hpp"
namespace tapstudy::protocols {
struct MendRequest {
  double longest_hole_m;  // round its border; longer ones stay open
  bool is_largest_piece_only;
  double near_m;  // pieces no further from the largest, or from another kept one, are kept
};

struct Holes {
  int filled{};
  int left{};
  double longest_m{};            // round the border of the longest, filled or not
  std::array<double, 3> at_m{};  // a point of that border
};

struct MendedSurface {
  core::TriangleSurface surface;
  Holes holes;
  int pieces_dropped{};
};

// Triangles without area and repeated ones dropped, neighbours turned to face alike and outward, a
// corner or edge at which more than two sheets meet parted into one for each, holes filled, all
// pieces but the largest, and those near it, dropped where that is asked for. What comes back need
// not be closed: see check_surface. Throws ModelError if that takes too long or too much memory.
MendedSurface mended(const core::TriangleSurface& surface, const MendRequest& request);
}  // namespace tapstudy::protocols
