#include "core/model/shape/check_surface.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>
#include <vector>

#include "core/error.hpp"
#include "core/geometry/triangle_tree.hpp"
#include "core/model/shape/shape.hpp"
namespace tapstudy::core {
namespace {
constexpr double smallest_m = 1e-3;
constexpr double largest_m = 10.0;
constexpr double no_area = 1e-12;   // of a triangle, as a fraction of its longest side squared
constexpr double no_volume = 1e-9;  // as a fraction of the bounding cube's
constexpr Eigen::Index most_triangles = 200000;

std::string place(const TriangleSurface& surface, int point) {
  const auto p = surface.points_m.row(point);
  return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", p.x(), p.y(), p.z());
}

void check_size(const TriangleSurface& surface) {
  if (surface.triangles.rows() > most_triangles) {
    throw InvalidInput{fmt::format("surface: {} triangles (at most {})", surface.triangles.rows(),
                                   most_triangles)};
  }
  if (!surface.points_m.allFinite()) {
    throw InvalidInput{"surface: a coordinate is not a finite number"};
  }
  const Vec3 size = bounds(surface).size_m();
  if (size.maxCoeff() > largest_m || size.maxCoeff() < smallest_m) {
    throw InvalidInput{fmt::format(
        "surface: it is {:.4g} × {:.4g} × {:.4g} m (from {} to {} m; is metres_per_unit right?)",
        size.x(), size.y(), size.z(), smallest_m, largest_m)};
  }
}

void check_areas(const TriangleSurface& surface) {
  for (Eigen::Index i = 0; i < surface.triangles.rows(); ++i) {
    const auto corner = [&](Eigen::Index k) -> Vec3 {
      return surface.points_m.row(surface.triangles(i, k));
    };
    const Vec3 ab = corner(1) - corner(0);
    const Vec3 ac = corner(2) - corner(0);
    const double longest = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
    if (!(ab.cross(ac).norm() > no_area * longest)) {
      throw InvalidInput{fmt::format("surface: triangle {} at {} has no area", i,
                                     place(surface, surface.triangles(i, 0)))};
    }
  }
}

using Edge = std::pair<int, int>;

std::map<Edge, std::vector<int>> triangles_along(const TriangleSurface& surface) {
  std::map<Edge, std::vector<int>> along;
  for (int i = 0; i < surface.triangles.rows(); ++i) {
    for (int k = 0; k < 3; ++k) {
      along[{surface.triangles(i, k), surface.triangles(i, (k + 1) % 3)}].push_back(i);
    }
  }
  return along;
}

void check_edges(const TriangleSurface& surface,
                 const std::map<Edge, std::vector<int>>& triangles_along_edge) {
  for (const auto& [edge, triangles] : triangles_along_edge) {
    const auto opposite = triangles_along_edge.find({edge.second, edge.first});
    const std::size_t back = opposite == triangles_along_edge.end() ? 0 : opposite->second.size();
    if (triangles.size() == 1 && back == 1) {
      continue;
    }
    const std::string where = fmt::format("along the edge from {} to {}",
                                          place(surface, edge.first), place(surface, edge.second));
    if (triangles.size() + back == 1) {
      throw InvalidInput{"surface: it is open (has a hole) " + where};
    }
    if (triangles.size() + back == 2) {
      throw InvalidInput{"surface: two neighbouring triangles face opposite ways " + where};
    }
    throw InvalidInput{
        fmt::format("surface: {} triangles meet (two may) {}", triangles.size() + back, where)};
  }
}

int find_root(std::vector<int>& parent, int i) {
  while (parent[static_cast<std::size_t>(i)] != i) {
    int& up = parent[static_cast<std::size_t>(i)];
    up = parent[static_cast<std::size_t>(up)];
    i = up;
  }
  return i;
}

void check_one_piece(const TriangleSurface& surface) {
  std::vector<int> parent(static_cast<std::size_t>(surface.points_m.rows()));
  std::iota(parent.begin(), parent.end(), 0);
  for (const auto& triangle : surface.triangles.rowwise()) {
    for (const int other : {triangle[1], triangle[2]}) {
      parent[static_cast<std::size_t>(find_root(parent, other))] = find_root(parent, triangle[0]);
    }
  }
  const int first = find_root(parent, surface.triangles(0, 0));
  for (const auto& triangle : surface.triangles.rowwise()) {
    if (find_root(parent, triangle[0]) != first) {
      throw InvalidInput{fmt::format(
          "surface: it is in several pieces, one at {}, another at {} (a body is one closed shell)",
          place(surface, surface.triangles(0, 0)), place(surface, triangle[0]))};
    }
  }
}

void check_volume(const TriangleSurface& surface) {
  const double volume = volume_m3(surface);
  const double cube = std::pow(bounds(surface).size_m().maxCoeff(), 3);
  if (!(std::abs(volume) > no_volume * cube)) {
    throw InvalidInput{fmt::format("surface: it encloses no volume ({:.3g} m³)", volume)};
  }
  if (volume < 0.0) {
    throw InvalidInput{"surface: its triangles face inward (turn every one of them round)"};
  }
}

bool share_a_point(const TriangleSurface& surface, int triangle, int a, int b) {
  const auto points = surface.triangles.row(triangle);
  return (points.array() == a).any() || (points.array() == b).any();
}

// Two triangles cross only where an edge of one passes through the other.
void check_crossings(const TriangleSurface& surface,
                     const std::map<Edge, std::vector<int>>& edges) {
  const TriangleTree tree{surface};
  for (const auto& [edge, triangles] : edges) {
    const auto [a, b] = edge;
    if (a > b) {
      continue;
    }
    const Vec3 from = surface.points_m.row(a);
    const Vec3 to = surface.points_m.row(b);
    int crossed = TriangleTree::none;
    tree.visit_along(from, to, [&, a = a, b = b](int triangle) {
      if (!share_a_point(surface, triangle, a, b) && tree.is_pierced(triangle, from, to)) {
        crossed = triangle;
      }
    });
    if (crossed != TriangleTree::none) {
      throw InvalidInput{fmt::format(
          "surface: it runs through itself: the edge from {} to {} passes through triangle {}",
          place(surface, a), place(surface, b), crossed)};
    }
  }
}
}  // namespace

void check_surface(const TriangleSurface& surface) {
  check_size(surface);
  check_areas(surface);
  const auto along = triangles_along(surface);
  check_edges(surface, along);
  check_one_piece(surface);
  check_volume(surface);
  check_crossings(surface, along);
}
}  // namespace tapstudy::core
