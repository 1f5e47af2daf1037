#include "core/geometry/smooth_normals.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
namespace tapstudy::core {
namespace {
using Point = SmoothNormals::Point;
constexpr double same_normal = 1e-9;
constexpr double rounding = 1e-9;      // of barycentric coordinates
constexpr double converged = 1e-10;    // of them, in Newton's method: the next step has its square
constexpr double least_volume = 1e-3;  // of the prism along the normals, to that on the surface
constexpr int max_iterations = 12;     // three or four, near the surface
constexpr int max_triangles_passed = 32;

Point corner_of(const TriangleSurface& surface, int triangle, int corner) noexcept {
  return surface.points_m.row(surface.triangles(triangle, corner));
}

double angle_at(const TriangleSurface& surface, int triangle, int corner) {
  const Point at = corner_of(surface, triangle, corner);
  const Point a = corner_of(surface, triangle, (corner + 1) % 3) - at;
  const Point b = corner_of(surface, triangle, (corner + 2) % 3) - at;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

int corner_with(const TriangleSurface& surface, int triangle, int point) {
  int corner = 0;
  while (surface.triangles(triangle, corner) != point) {
    ++corner;
  }
  return corner;
}

template <class Get>
Point interpolated(const std::array<double, 3>& at, const Get& get) noexcept {
  return at[0] * get(0) + at[1] * get(1) + at[2] * get(2);
}
}  // namespace

SmoothNormals::SmoothNormals(const TriangleSurface& surface, const Points& face_normals) {
  const auto count = static_cast<int>(surface.triangles.rows());
  join_neighbours(surface, face_normals);
  for (int triangle = 0; triangle < count; ++triangle) {
    const Point own = face_normals.row(triangle);
    bool is_flat = true;
    for (int corner = 0; corner < 3; ++corner) {
      normals_.push_back(mean_around(surface, face_normals, triangle, corner));
      is_flat = is_flat && (normals_.back() - own).norm() <= same_normal;
    }
    is_flat_.push_back(is_flat);
  }
}

// Two triangles are neighbours if they share an edge, once each way round, that is smooth.
void SmoothNormals::join_neighbours(const TriangleSurface& surface, const Points& face_normals) {
  const auto count = static_cast<int>(surface.triangles.rows());
  std::map<std::pair<int, int>, int> numbers;  // of 3 triangle + edge, by start and end
  const auto ends = [&](int triangle, int edge) {
    return std::pair{surface.triangles(triangle, (edge + 1) % 3),
                     surface.triangles(triangle, (edge + 2) % 3)};
  };
  for (int number = 0; number < 3 * count; ++number) {
    numbers.emplace(ends(number / 3, number % 3), number);
  }
  neighbours_.assign(static_cast<std::size_t>(3 * count), none);
  for (int number = 0; number < 3 * count; ++number) {
    const auto [start, end] = ends(number / 3, number % 3);
    const auto other = numbers.find({end, start});
    if (other == numbers.end()) {
      continue;
    }
    const Point a = face_normals.row(number / 3);
    const Point b = face_normals.row(other->second / 3);
    if (std::atan2(a.cross(b).norm(), a.dot(b)) <= sharp_above_rad) {
      neighbours_[static_cast<std::size_t>(number)] = other->second / 3;
    }
  }
}

// Once around the corner over smooth edges, or to both sides until sharp ones.
Point SmoothNormals::mean_around(const TriangleSurface& surface, const Points& face_normals,
                                 int triangle, int corner) const {
  const int point = surface.triangles(triangle, corner);
  const auto weighted = [&](int other) {
    return Point{angle_at(surface, other, corner_with(surface, other, point)) *
                 face_normals.row(other).transpose()};
  };
  Point sum = weighted(triangle);
  for (const int side : {1, 2}) {
    int other = neighbour(triangle, (corner + side) % 3);
    while (other != none && other != triangle) {
      sum += weighted(other);
      other = neighbour(other, (corner_with(surface, other, point) + side) % 3);
    }
    if (other == triangle) {
      break;
    }
  }
  return sum.normalized();
}

int SmoothNormals::exit_edge(int triangle, const std::array<double, 3>& at) const noexcept {
  int edge = none;
  for (int i = 0; i < 3; ++i) {
    const double here = at[static_cast<std::size_t>(i)];
    const bool is_beyond = here < -rounding && neighbour(triangle, i) != none;
    if (is_beyond && (edge == none || here < at[static_cast<std::size_t>(edge)])) {
      edge = i;
    }
  }
  return edge;
}

// Newton's method for p = g - d n with g and n linear in the barycentric coordinates.
std::optional<SmoothNormals::Foot> SmoothNormals::foot_on(
    int triangle, const Point& inside_m, const TriangleSurface& surface) const noexcept {
  const Point a = corner_of(surface, triangle, 0);
  const Point ab = corner_of(surface, triangle, 1) - a;
  const Point ac = corner_of(surface, triangle, 2) - a;
  const Point to_b = normal(triangle, 1) - normal(triangle, 0);
  const Point to_c = normal(triangle, 2) - normal(triangle, 0);
  const Point outward = ab.cross(ac);
  const double volume_at_surface = outward.norm();
  double b = 1.0 / 3.0;
  double c = 1.0 / 3.0;
  double depth = outward.dot(a - inside_m) / volume_at_surface;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const Point n = normal(triangle, 0) + b * to_b + c * to_c;
    const Point missing = inside_m - (a + b * ab + c * ac - depth * n);
    const Point along_b = ab - depth * to_b;
    const Point along_c = ac - depth * to_c;
    const double volume = along_b.cross(along_c).dot(n);
    if (!(volume > least_volume * volume_at_surface)) {
      return std::nullopt;
    }
    const double step_b = missing.cross(along_c).dot(n) / volume;
    const double step_c = along_b.cross(missing).dot(n) / volume;
    b += step_b;
    c += step_c;
    depth -= along_b.cross(along_c).dot(missing) / volume;
    if (std::abs(step_b) + std::abs(step_c) <= converged) {
      const Point there = normal(triangle, 0) + b * to_b + c * to_c;
      const double length = there.norm();
      return Foot{triangle,       {1.0 - b - c, b, c}, a + b * ab + c * ac,
                  there / length, depth * length,      false};
    }
  }
  return std::nullopt;
}

// Moves the foot to the nearest coordinates within the triangle, with the distance along the normal
// there.
void SmoothNormals::pull_to_edge(Foot& foot, const Point& inside_m,
                                 const TriangleSurface& surface) const noexcept {
  double sum = 0.0;
  for (double& coordinate : foot.barycentric) {
    coordinate = std::max(0.0, coordinate);
    sum += coordinate;
  }
  for (double& coordinate : foot.barycentric) {
    coordinate /= sum;
  }
  foot.place_m =
      interpolated(foot.barycentric, [&](int i) { return corner_of(surface, foot.triangle, i); });
  foot.normal =
      interpolated(foot.barycentric, [&](int i) { return normal(foot.triangle, i); }).normalized();
  foot.depth_m = foot.normal.dot(foot.place_m - inside_m);
  foot.is_at_sharp_edge = true;
}

std::optional<SmoothNormals::Foot> SmoothNormals::foot_of(
    const Point& inside_m, int nearby, const TriangleSurface& surface) const noexcept {
  int triangle = nearby;
  for (int passed = 0; passed < max_triangles_passed; ++passed) {
    std::optional<Foot> foot = foot_on(triangle, inside_m, surface);
    if (!foot) {
      return std::nullopt;
    }
    const bool is_inside =
        std::ranges::all_of(foot->barycentric, [](double at) { return at >= -rounding; });
    if (is_inside) {
      return foot;
    }
    const int edge = exit_edge(triangle, foot->barycentric);
    if (edge == none) {
      pull_to_edge(*foot, inside_m, surface);
      return foot;
    }
    triangle = neighbour(triangle, edge);
  }
  return std::nullopt;
}
}  // namespace tapstudy::core
