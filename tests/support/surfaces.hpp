#pragma once
#include <cmath>
#include <map>
#include <vector>

#include "core/geometry/triangle_surface.hpp"
namespace tapstudy::testing {
inline core::TriangleSurface surface_of(const std::vector<Eigen::RowVector3d>& points,
                                        const std::vector<Eigen::RowVector3i>& triangles) {
  core::TriangleSurface surface;
  surface.points_m.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    surface.points_m.row(static_cast<Eigen::Index>(i)) = points[i];
  }
  surface.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    surface.triangles.row(static_cast<Eigen::Index>(i)) = triangles[i];
  }
  return surface;
}

// The outer faces of those cells of a grid that are full.
template <class IsFull>
core::TriangleSurface cells_surface(const Eigen::Vector3d& low, const Eigen::Vector3d& cell,
                                    const Eigen::Vector3i& count, const IsFull& is_full) {
  std::vector<Eigen::RowVector3d> points;
  std::vector<Eigen::RowVector3i> triangles;
  std::map<std::array<int, 3>, int> numbers;
  const auto number = [&](const Eigen::Vector3i& at) {
    const auto [found, is_new] =
        numbers.emplace(std::array{at[0], at[1], at[2]}, static_cast<int>(points.size()));
    if (is_new) {
      points.emplace_back((low + at.cast<double>().cwiseProduct(cell)).transpose());
    }
    return found->second;
  };
  const auto full = [&](const Eigen::Vector3i& at) {
    return (at.array() >= 0).all() && (at.array() < count.array()).all() && is_full(at);
  };
  for (int i = 0; i < count.prod(); ++i) {
    const Eigen::Vector3i at{i % count[0], i / count[0] % count[1], i / count[0] / count[1]};
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        const Eigen::Vector3i step = Eigen::Vector3i::Unit(axis);
        if (!full(at) ||
            full(side == 1 ? Eigen::Vector3i{at + step} : Eigen::Vector3i{at - step})) {
          continue;
        }
        const Eigen::Vector3i u = Eigen::Vector3i::Unit((axis + 1) % 3);
        const Eigen::Vector3i v = Eigen::Vector3i::Unit((axis + 2) % 3);
        const Eigen::Vector3i base = at + side * step;
        const int a = number(base);
        const int b = number(base + u);
        const int c = number(base + u + v);
        const int d = number(base + v);
        if (side == 1) {
          triangles.emplace_back(a, b, c);
          triangles.emplace_back(a, c, d);
        } else {
          triangles.emplace_back(a, c, b);
          triangles.emplace_back(a, d, c);
        }
      }
    }
  }
  return surface_of(points, triangles);
}

// In the plate frame: the top at z = 0.
inline core::TriangleSurface box_surface(const Eigen::Vector3d& size_m, int cells = 1) {
  const Eigen::Vector3d low{-0.5 * size_m.x(), -0.5 * size_m.y(), -size_m.z()};
  return cells_surface(low, size_m / cells, {cells, cells, cells},
                       [](const Eigen::Vector3i& /*at*/) { return true; });
}

// 0.2 × 0.2 × 0.1 m with a quarter cut out of its upper half: floor at z = -0.05, walls at x = 0
// and y = 0.
inline core::TriangleSurface notched_block() {
  return cells_surface({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.05}, {2, 2, 2},
                       [](const Eigen::Vector3i& at) {
                         return at != Eigen::Vector3i{1, 1, 1};
                       });
}

// Around the origin, cut along `rings` circles of latitude.
inline core::TriangleSurface sphere_surface(double radius_m, int rings) {
  std::vector<Eigen::RowVector3d> points{{0.0, 0.0, radius_m}};
  std::vector<Eigen::RowVector3i> triangles;
  const int around = 2 * rings;
  for (int ring = 1; ring < rings; ++ring) {
    for (int k = 0; k < around; ++k) {
      const double polar = M_PI * ring / rings;
      const double turn = 2.0 * M_PI * k / around;
      points.emplace_back(radius_m * std::sin(polar) * std::cos(turn),
                          radius_m * std::sin(polar) * std::sin(turn), radius_m * std::cos(polar));
    }
  }
  const int south = static_cast<int>(points.size());
  points.emplace_back(0.0, 0.0, -radius_m);
  const auto number = [&](int ring, int k) { return 1 + (ring - 1) * around + k % around; };
  for (int k = 0; k < around; ++k) {
    triangles.emplace_back(0, number(1, k), number(1, k + 1));
    triangles.emplace_back(south, number(rings - 1, k + 1), number(rings - 1, k));
    for (int ring = 1; ring + 1 < rings; ++ring) {
      triangles.emplace_back(number(ring, k), number(ring + 1, k), number(ring + 1, k + 1));
      triangles.emplace_back(number(ring, k), number(ring + 1, k + 1), number(ring, k + 1));
    }
  }
  return surface_of(points, triangles);
}
}  // namespace tapstudy::testing
