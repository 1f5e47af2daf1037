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

// The triangles of both, each with its own points.
inline core::TriangleSurface joined_surfaces(const core::TriangleSurface& a,
                                             const core::TriangleSurface& b) {
  core::TriangleSurface both;
  both.points_m.resize(a.points_m.rows() + b.points_m.rows(), 3);
  both.points_m << a.points_m, b.points_m;
  both.triangles.resize(a.triangles.rows() + b.triangles.rows(), 3);
  both.triangles << a.triangles, b.triangles.array() + static_cast<int>(a.points_m.rows());
  return both;
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

// Around the origin: an icosahedron, its triangles cut into four so many times.
inline core::TriangleSurface icosphere_surface(double radius_m, int cuts) {
  const double golden = 0.5 * (1.0 + std::sqrt(5.0));
  std::vector<Eigen::RowVector3d> points;
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-golden, golden}) {
      points.insert(points.end(), {{0.0, a, b}, {a, b, 0.0}, {b, 0.0, a}});
    }
  }
  std::vector<Eigen::RowVector3i> triangles;
  for (int i = 0; i < 12; ++i) {
    for (int j = i + 1; j < 12; ++j) {
      for (int k = j + 1; k < 12; ++k) {
        const auto near = [&](int a, int b) {
          return (points[static_cast<std::size_t>(a)] - points[static_cast<std::size_t>(b)])
                     .norm() < 2.1;
        };
        if (near(i, j) && near(j, k) && near(k, i)) {
          triangles.emplace_back(i, j, k);
        }
      }
    }
  }
  for (int cut = 0; cut < cuts; ++cut) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [found, is_new] =
          middles.emplace(std::minmax(a, b), static_cast<int>(points.size()));
      if (is_new) {
        points.emplace_back(0.5 * (points[static_cast<std::size_t>(a)].normalized() +
                                   points[static_cast<std::size_t>(b)].normalized()));
      }
      return found->second;
    };
    std::vector<Eigen::RowVector3i> finer;
    for (const Eigen::RowVector3i& t : triangles) {
      const Eigen::RowVector3i m{middle(t[0], t[1]), middle(t[1], t[2]), middle(t[2], t[0])};
      finer.insert(finer.end(), {{t[0], m[0], m[2]}, {t[1], m[1], m[0]}, {t[2], m[2], m[1]}, m});
    }
    triangles = finer;
  }
  for (Eigen::RowVector3d& point : points) {
    point *= radius_m / point.norm();
  }
  for (Eigen::RowVector3i& t : triangles) {
    const auto at = [&](int i) {
      return points[static_cast<std::size_t>(t[i])].transpose().eval();
    };
    if (at(0).dot(at(1).cross(at(2))) < 0.0) {
      std::swap(t[1], t[2]);
    }
  }
  return surface_of(points, triangles);
}

// A closed grid of around × along quadrilaterals, each cut in two; the point at (i, j).
template <class At>
core::TriangleSurface wrapped_surface(int around, int along, const At& at) {
  std::vector<Eigen::RowVector3d> points;
  std::vector<Eigen::RowVector3i> triangles;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < along; ++j) {
      points.push_back(at(i, j));
      const int next = (i + 1) % around;
      const int a = i * along + j;
      const int b = next * along + j;
      const int c = next * along + (j + 1) % along;
      const int d = i * along + (j + 1) % along;
      triangles.emplace_back(a, b, c);
      triangles.emplace_back(a, c, d);
    }
  }
  return surface_of(points, triangles);
}

// Around the z axis.
inline core::TriangleSurface torus_surface(double radius_m, double tube_m, int around, int along) {
  return wrapped_surface(around, along, [&](int i, int j) -> Eigen::RowVector3d {
    const double u = 2.0 * M_PI * i / around;
    const double v = 2.0 * M_PI * j / along;
    const double out = radius_m + tube_m * std::cos(v);
    return {out * std::cos(u), out * std::sin(u), tube_m * std::sin(v)};
  });
}

// A prism along y, 0.2 m long: the profile's points (x, z) in the order that turns x towards -z,
// clockwise seen from -y. Its ends are fans, so the profile is star-shaped about its first point.
inline core::TriangleSurface prism_surface(const std::vector<Eigen::Vector2d>& profile, int cells) {
  std::vector<Eigen::RowVector3d> points;
  std::vector<Eigen::RowVector3i> triangles;
  const auto count = static_cast<int>(profile.size());
  for (int j = 0; j <= cells; ++j) {
    for (const Eigen::Vector2d& at : profile) {
      points.emplace_back(at.x(), 0.2 * j / cells - 0.1, at.y());
    }
  }
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < count; ++i) {
      const int a = j * count + i;
      const int b = j * count + (i + 1) % count;
      triangles.emplace_back(a, b, b + count);
      triangles.emplace_back(a, b + count, a + count);
    }
  }
  const int last = cells * count;
  for (int i = 1; i + 1 < count; ++i) {
    triangles.emplace_back(0, i + 1, i);
    triangles.emplace_back(last, last + i, last + i + 1);
  }
  return surface_of(points, triangles);
}
}  // namespace tapstudy::testing
