#pragma once
#include "support/surfaces.hpp"
namespace tapstudy::testing {
// A cube of 0.1 m with fins as long, whose two faces are so far apart at the root, and meet in an
// edge: a mesher makes the elements there the smaller, the better shaped they have to be.
inline core::TriangleSurface sharp_fins(int fins, double root_m) {
  std::vector<Eigen::RowVector2d> outline{{0.0, 0.0}, {0.1, 0.0}};
  for (int fin = 1; fin <= fins; ++fin) {
    const double middle = 0.1 * fin / (fins + 1);
    outline.emplace_back(0.1, middle - 0.5 * root_m);
    outline.emplace_back(0.2, middle);
    outline.emplace_back(0.1, middle + 0.5 * root_m);
  }
  outline.emplace_back(0.1, 0.1);
  outline.emplace_back(0.0, 0.1);
  const auto corners = static_cast<int>(outline.size());
  std::vector<Eigen::RowVector3d> points;
  for (const double z : {0.0, 0.1}) {
    for (const Eigen::RowVector2d& corner : outline) {
      points.emplace_back(corner.x(), corner.y(), z);
    }
  }
  std::vector<Eigen::RowVector3i> triangles;
  const auto add_to_both_ends = [&](int i, int j, int k) {
    triangles.emplace_back(k, j, i);
    triangles.emplace_back(i + corners, j + corners, k + corners);
  };
  for (int i = 1; i + 1 < corners; ++i) {
    const bool begins_fin = i % 3 == 2 && i < 3 * fins + 1;
    add_to_both_ends(0, i, begins_fin ? i + 2 : i + 1);
    if (begins_fin) {
      add_to_both_ends(i, i + 1, i + 2);
      ++i;
    }
  }
  for (int i = 0; i < corners; ++i) {
    const int next = (i + 1) % corners;
    triangles.emplace_back(i, next, next + corners);
    triangles.emplace_back(i, next + corners, i + corners);
  }
  return surface_of(points, triangles);
}
}  // namespace tapstudy::testing
