#include "protocols/surface/surface_points.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "protocols/surface/flat_triangle.hpp"
namespace tapstudy::protocols {
using core::TriangleSurface;
using core::Vec3;

TriangleSurface parted(const TriangleSurface& surface) {
  TriangleSurface apart;
  apart.points_m.resize(3 * surface.triangles.rows(), 3);
  Eigen::Index points = 0;
  for (Eigen::Index i = 0; i < surface.triangles.rows(); ++i) {
    const std::array<Vec3, 3> corners{surface.points_m.row(surface.triangles(i, 0)),
                                      surface.points_m.row(surface.triangles(i, 1)),
                                      surface.points_m.row(surface.triangles(i, 2))};
    if (!has_no_area(corners[0], corners[1], corners[2])) {
      for (const Vec3& corner : corners) {
        apart.points_m.row(points++) = corner.transpose();
      }
    }
  }
  apart.points_m.conservativeResize(points, 3);
  apart.triangles.resize(points / 3, 3);
  for (Eigen::Index i = 0; i < points; ++i) {
    apart.triangles(i / 3, i % 3) = static_cast<int>(i);
  }
  return apart;
}

void visit_points(const TriangleSurface& surface, double apart_m,
                  const std::function<bool(const Vec3& at_m)>& visit) {
  constexpr int most_parts = 50;
  for (const auto& t : surface.triangles.rowwise()) {
    const Vec3 a = surface.points_m.row(t[0]);
    const Vec3 ab = surface.points_m.row(t[1]).transpose() - a;
    const Vec3 ac = surface.points_m.row(t[2]).transpose() - a;
    const double longest_m = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
    const int parts = std::clamp(static_cast<int>(std::ceil(longest_m / apart_m)), 1, most_parts);
    for (int u = 0; u <= parts; ++u) {
      for (int v = 0; u + v <= parts; ++v) {
        if (!visit(a + ab * u / parts + ac * v / parts)) {
          return;
        }
      }
    }
    if (!visit(a + (ab + ac) / 3.0)) {
      return;
    }
  }
}
}  // namespace tapstudy::protocols
