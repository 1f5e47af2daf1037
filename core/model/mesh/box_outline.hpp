#pragma once
#include <array>
#include <vector>

#include "core/model/shape/box.hpp"
namespace tapstudy::core {
// The six faces of a box as polygons over a list of points: the mesher's input, such that given
// points on faces and edges become nodes.
struct BoxOutline {
  struct Side {
    std::vector<int> loop;    // the border: corners and the points on the edges, in order
    std::vector<int> inside;  // points strictly inside the face
  };
  std::vector<Vec3> points_m;  // the eight corners first, no duplicates
  std::array<Side, 6> sides;
};

// Points closer than snap_m are merged.
BoxOutline outline(const Box& box, const std::vector<Vec3>& points_m, double snap_m);
}  // namespace tapstudy::core
