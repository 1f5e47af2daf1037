#include "core/model/mesh/box_outline.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
namespace tapstudy::core {
namespace {
using Corners = std::array<int, 4>;

// Corners 0 to 3 once around the bottom, 4 to 7 above them. TetGen's mesh depends on the order of
// points and faces, so the order is part of what makes a study repeatable.
constexpr std::array<Corners, 6> corner_loops{Corners{0, 1, 2, 3}, Corners{4, 5, 6, 7},
                                              Corners{0, 1, 5, 4}, Corners{1, 2, 6, 5},
                                              Corners{2, 3, 7, 6}, Corners{3, 0, 4, 7}};

Vec3 corner(const Box& box, int k) {
  const int around = k % 4;
  return {around == 1 || around == 2 ? box.high_m().x() : box.low_m().x(),
          around >= 2 ? box.high_m().y() : box.low_m().y(),
          k >= 4 ? box.high_m().z() : box.low_m().z()};
}

// Parameter of p along the edge: 0 at its start, 1 at its end, -1 off the edge.
double along_edge(const Vec3& p, const Vec3& from, const Vec3& to, double tolerance_m) {
  const Vec3 edge = to - from;
  const double t = (p - from).dot(edge) / edge.squaredNorm();
  const bool is_on_edge = (from + t * edge - p).norm() <= tolerance_m;
  return is_on_edge ? t : -1.0;
}

std::vector<int> points_on_edge(const std::vector<Vec3>& points, int from, int to,
                                double tolerance_m) {
  const auto place = [&](int i) {
    return along_edge(points.at(static_cast<std::size_t>(i)),
                      points.at(static_cast<std::size_t>(from)),
                      points.at(static_cast<std::size_t>(to)), tolerance_m);
  };
  std::vector<int> found;
  for (int i = 8; i < static_cast<int>(points.size()); ++i) {
    if (place(i) > 0.0 && place(i) < 1.0) {
      found.push_back(i);
    }
  }
  std::ranges::sort(found, {}, place);
  return found;
}

BoxOutline::Side side_of(const std::vector<Vec3>& points, const Corners& corners,
                         double tolerance_m) {
  const auto point = [&](int i) { return points.at(static_cast<std::size_t>(i)); };
  BoxOutline::Side side;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const int from = corners.at(k);
    const int to = corners.at((k + 1) % corners.size());
    side.loop.push_back(from);
    const std::vector<int> between = points_on_edge(points, from, to, tolerance_m);
    side.loop.insert(side.loop.end(), between.begin(), between.end());
  }
  const Vec3 u = point(corners[1]) - point(corners[0]);
  const Vec3 v = point(corners[3]) - point(corners[0]);
  const Vec3 normal = u.cross(v).normalized();
  for (int i = 8; i < static_cast<int>(points.size()); ++i) {
    const bool is_in_plane = std::abs(normal.dot(point(i) - point(corners[0]))) <= tolerance_m;
    if (is_in_plane && std::ranges::find(side.loop, i) == side.loop.end()) {
      side.inside.push_back(i);
    }
  }
  return side;
}
}  // namespace

BoxOutline outline(const Box& box, const std::vector<Vec3>& points_m, double snap_m) {
  const double tolerance_m = snap_m;
  BoxOutline result;
  for (int k = 0; k < 8; ++k) {
    result.points_m.push_back(corner(box, k));
  }
  for (const Vec3& point : points_m) {
    const bool is_new = std::ranges::none_of(
        result.points_m, [&](const Vec3& other) { return (other - point).norm() <= tolerance_m; });
    if (is_new) {
      result.points_m.push_back(point);
    }
  }
  for (std::size_t i = 0; i < result.sides.size(); ++i) {
    result.sides.at(i) = side_of(result.points_m, corner_loops.at(i), tolerance_m);
  }
  return result;
}
}  // namespace tapstudy::core
