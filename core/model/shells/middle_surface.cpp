#include "core/model/shells/middle_surface.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "core/algebra/dense_solvers.hpp"
#include "core/error.hpp"
#include "core/geometry/smooth_normals.hpp"
#include "core/geometry/triangle_tree.hpp"
namespace tapstudy::core {
namespace {
using Ends = std::array<int, 2>;

Ends ascending(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

Vec3 area_normal(const TriangleSurface& facets, Eigen::Index triangle) {
  const Vec3 first = facets.points_m.row(facets.triangles(triangle, 0));
  const Vec3 second = facets.points_m.row(facets.triangles(triangle, 1));
  const Vec3 third = facets.points_m.row(facets.triangles(triangle, 2));
  return (second - first).cross(third - first);
}

std::map<Ends, int> triangles_by_edge(const TriangleSurface& facets) {
  std::map<Ends, int> by_edge;
  for (int triangle = 0; triangle < facets.triangles.rows(); ++triangle) {
    for (int k = 0; k < 3; ++k) {
      by_edge[{facets.triangles(triangle, k), facets.triangles(triangle, (k + 1) % 3)}] = triangle;
    }
  }
  return by_edge;
}

double angle(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}
}  // namespace

MiddleSurface middle_surface(TriangleSurface facets) {
  MiddleSurface surface{std::move(facets), {}};
  const auto by_edge = triangles_by_edge(surface.facets);
  for (const auto& [ends, triangle] : by_edge) {
    const auto other = by_edge.find({ends[1], ends[0]});
    if (other != by_edge.end() &&
        angle(area_normal(surface.facets, triangle), area_normal(surface.facets, other->second)) >
            SmoothNormals::sharp_above_rad) {
      surface.folds.insert(ascending(ends[0], ends[1]));
    }
  }
  return surface;
}

CurvedTriangles::CurvedTriangles(const MiddleSurface& surface)
    : surface_{surface}, triangle_of_edge_{triangles_by_edge(surface.facets)} {
  join_fans();
  for (int fan = 0; fan < static_cast<int>(members_.size()); ++fan) {
    normals_.push_back(fitted_normal(fan));
  }
  find_rims();
  for (Eigen::Index triangle = 0; triangle < surface_.facets.triangles.rows(); ++triangle) {
    controls_m_.push_back(controls_of(triangle));
  }
}

bool CurvedTriangles::is_smooth(int from, int to) const {
  return triangle_of_edge_.contains({to, from}) && triangle_of_edge_.contains({from, to}) &&
         !surface_.folds.contains(ascending(from, to));
}

void CurvedTriangles::join_fans() {
  const auto slots = static_cast<std::size_t>(3 * surface_.facets.triangles.rows());
  std::vector<std::size_t> parent(slots);
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t slot) {
    while (parent[slot] != slot) {
      slot = parent[slot] = parent[parent[slot]];
    }
    return slot;
  };
  const auto slot_of = [&](int triangle, int point) {
    const auto row = surface_.facets.triangles.row(triangle);
    return static_cast<std::size_t>(3 * triangle + (row[0] == point ? 0 : row[1] == point ? 1 : 2));
  };
  for (const auto& [ends, triangle] : triangle_of_edge_) {
    if (is_smooth(ends[0], ends[1])) {
      const int other = triangle_of_edge_.at({ends[1], ends[0]});
      for (const int point : ends) {
        parent[root(slot_of(triangle, point))] = root(slot_of(other, point));
      }
    }
  }
  std::map<std::size_t, int> number_of;
  for (std::size_t slot = 0; slot < slots; ++slot) {
    const int number =
        number_of.try_emplace(root(slot), static_cast<int>(number_of.size())).first->second;
    fans_.push_back(number);
    members_.resize(number_of.size());
    members_[static_cast<std::size_t>(number)].push_back(
        {static_cast<int>(slot / 3), static_cast<int>(slot % 3)});
  }
}

// Exact on spheres (Max 1999, Weights for computing vertex normals from facet normals).
Vec3 CurvedTriangles::mean_normal(int fan) const {
  Vec3 sum = Vec3::Zero();
  for (const auto& [triangle, k] : members_[static_cast<std::size_t>(fan)]) {
    const Vec3 at_m = point_m(corner(triangle, k));
    const Vec3 a = point_m(corner(triangle, (k + 1) % 3)) - at_m;
    const Vec3 b = point_m(corner(triangle, (k + 2) % 3)) - at_m;
    sum += a.cross(b) / (a.squaredNorm() * b.squaredNorm());
  }
  return sum.normalized();
}

// Of the fan's triangles, and of those round their corners.
std::set<int> CurvedTriangles::points_near(int fan) const {
  std::set<int> points;
  for (const auto& [triangle, k] : members_[static_cast<std::size_t>(fan)]) {
    for (int other = 0; other < 3; ++other) {
      const int beside = fans_[static_cast<std::size_t>(3 * triangle + other)];
      for (const auto& member : members_[static_cast<std::size_t>(beside)]) {
        for (int i = 0; i < 3; ++i) {
          points.insert(corner(member[0], i));
        }
      }
    }
  }
  return points;
}

// The normal of a paraboloid through the point, fitted to those near it: as good at rims as between
// (Cazals & Pouget 2005, Estimating differential quantities using polynomial fitting).
Vec3 CurvedTriangles::fitted_normal(int fan) const {
  constexpr double told = 1e-6;
  const Vec3 mean = mean_normal(fan);
  const auto& [triangle, k] = members_[static_cast<std::size_t>(fan)].front();
  const int at = corner(triangle, k);
  std::set<int> near = points_near(fan);
  near.erase(at);
  const Vec3 along = mean.unitOrthogonal();
  const Vec3 beside = mean.cross(along);
  double size_m = 0.0;
  for (const int point : near) {
    size_m = std::max(size_m, (point_m(point) - point_m(at)).norm());
  }
  const auto rows = static_cast<Eigen::Index>(near.size());
  Eigen::MatrixXd terms(rows, 5);
  Eigen::VectorXd heights(rows);
  Eigen::Index row = 0;
  for (const int point : near) {
    const Vec3 from = (point_m(point) - point_m(at)) / size_m;
    const double weight = 1.0 / from.squaredNorm();
    const double x = from.dot(along);
    const double y = from.dot(beside);
    terms.row(row) << x, y, x * x, x * y, y * y;
    terms.row(row) *= weight;
    heights[row++] = weight * from.dot(mean);
  }
  const Eigen::VectorXd found = shortest_solution(terms, heights, told);
  const Vec3 normal = (mean - found[0] * along - found[1] * beside).normalized();
  const bool is_told =
      rows >= 5 && normal.allFinite() && angle(normal, mean) < SmoothNormals::sharp_above_rad;
  return is_told ? normal : mean;
}

// The tangent of a rim or fold is that of the circle through the point and its two neighbours.
void CurvedTriangles::find_rims() {
  std::map<int, std::set<int>> neighbours;
  for (const auto& [ends, triangle] : triangle_of_edge_) {
    if (!is_smooth(ends[0], ends[1])) {
      neighbours[ends[0]].insert(ends[1]);
      neighbours[ends[1]].insert(ends[0]);
    }
  }
  for (const auto& [point, others] : neighbours) {
    if (others.size() == 2) {
      const Vec3 from = point_m(point) - point_m(*others.begin());
      const Vec3 to = point_m(*others.rbegin()) - point_m(point);
      if (angle(from, to) <= SmoothNormals::sharp_above_rad) {
        tangents_[point] = (from / from.squaredNorm() + to / to.squaredNorm()).normalized();
      }
    }
  }
}

// Where only the other end turns smoothly, the tangent of a circle from there.
Vec3 CurvedTriangles::tangent_on_rim(int from, int to) const {
  const Vec3 chord = (point_m(to) - point_m(from)).normalized();
  const auto onward = [&](const Vec3& tangent) {
    return Vec3{tangent.dot(chord) < 0.0 ? -tangent : tangent};
  };
  if (const auto here = tangents_.find(from); here != tangents_.end()) {
    return onward(here->second);
  }
  if (const auto there = tangents_.find(to); there != tangents_.end()) {
    const Vec3 tangent = onward(there->second);
    return 2.0 * chord.dot(tangent) * chord - tangent;
  }
  return chord;
}

Vec3 CurvedTriangles::control_m(Eigen::Index triangle, int from, int to) const {
  const int start = corner(triangle, from);
  const int end = corner(triangle, to);
  const Vec3 chord_m = point_m(end) - point_m(start);
  Vec3 tangent = tangent_on_rim(start, end);
  if (is_smooth(start, end)) {
    const Vec3& normal = normals_[static_cast<std::size_t>(fan(triangle, from))];
    tangent = (chord_m - chord_m.dot(normal) * normal).normalized();
  }
  const double length_m = chord_m.norm();
  const double of_circle = 2.0 / (3.0 * (1.0 + tangent.dot(chord_m) / length_m));
  return point_m(start) + of_circle * length_m * tangent;
}

// Of corners, of the edges 01 10 12 21 20 02, and of the middle.
std::array<Vec3, 10> CurvedTriangles::controls_of(Eigen::Index triangle) const {
  std::array<Vec3, 10> controls_m;
  Vec3 corners_m = Vec3::Zero();
  Vec3 edges_m = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const int next = (k + 1) % 3;
    controls_m.at(at) = point_m(corner(triangle, k));
    controls_m.at(3 + 2 * at) = control_m(triangle, k, next);
    controls_m.at(4 + 2 * at) = control_m(triangle, next, k);
    corners_m += controls_m.at(at) / 3.0;
    edges_m += (controls_m.at(3 + 2 * at) + controls_m.at(4 + 2 * at)) / 6.0;
  }
  controls_m[9] = 1.5 * edges_m - 0.5 * corners_m;
  return controls_m;
}

Vec3 CurvedTriangles::at_m(Eigen::Index triangle, double x, double y) const {
  const auto& c = controls_m_[static_cast<std::size_t>(triangle)];
  const double a = 1.0 - x - y;
  return a * a * a * c[0] + x * x * x * c[1] + y * y * y * c[2] +
         3.0 * (a * a * x * c[3] + a * x * x * c[4] + x * x * y * c[5] + x * y * y * c[6] +
                y * y * a * c[7] + y * a * a * c[8]) +
         6.0 * a * x * y * c[9];
}

namespace {
// One round of division: a new point in the middle of each long edge.
class Division {
 public:
  Division(const MiddleSurface& surface, double longest_m, const std::vector<FilledRegion>& regions)
      : curved_{surface}, surface_{surface} {
    for (const auto& point : surface.facets.points_m.rowwise()) {
      points_m_.emplace_back(point);
    }
    const TriangleTree tree{surface.facets};
    for (Eigen::Index triangle = 0; triangle < surface.facets.triangles.rows(); ++triangle) {
      double allowed_m = longest_m;
      for (const FilledRegion& region : regions) {
        const double away_m = std::max(0.0, distance_m(region, triangle, tree));
        allowed_m = std::min(allowed_m, 0.5 * region.width_m + away_m);
      }
      mark_longer(triangle, allowed_m);
    }
  }

  // nullopt: no edge is too long.
  std::optional<MiddleSurface> divided() {
    for (Eigen::Index triangle = 0; triangle < surface_.facets.triangles.rows(); ++triangle) {
      divide(triangle);
    }
    if (middles_.empty()) {
      return std::nullopt;
    }
    MiddleSurface result;
    result.facets.points_m.resize(static_cast<Eigen::Index>(points_m_.size()), 3);
    for (std::size_t i = 0; i < points_m_.size(); ++i) {
      result.facets.points_m.row(static_cast<Eigen::Index>(i)) = points_m_[i].transpose();
    }
    result.facets.triangles.resize(static_cast<Eigen::Index>(triangles_.size()), 3);
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      result.facets.triangles.row(static_cast<Eigen::Index>(i)) << triangles_[i][0],
          triangles_[i][1], triangles_[i][2];
    }
    for (const Ends& fold : surface_.folds) {
      if (const auto middle = middles_.find(fold); middle != middles_.end()) {
        result.folds.insert(ascending(fold[0], middle->second));
        result.folds.insert(ascending(fold[1], middle->second));
      } else {
        result.folds.insert(fold);
      }
    }
    return result;
  }

 private:
  static constexpr int none = -1;

  // Between two convex sets, by projections onto one and the other in turn (Cheney & Goldstein
  // 1959, Proximity maps for convex sets); less than 0 inside what is rounded.
  double distance_m(const FilledRegion& region, Eigen::Index triangle,
                    const TriangleTree& tree) const {
    constexpr int projections = 10;
    Vec3 in_box_m = 0.5 * (region.low_m + region.high_m);
    Vec3 in_triangle_m;
    for (int i = 0; i < projections; ++i) {
      in_triangle_m = nearest_m(triangle, in_box_m, tree);
      in_box_m = in_triangle_m.cwiseMax(region.low_m).cwiseMin(region.high_m);
    }
    return (in_triangle_m - in_box_m).norm() - region.rounding_m;
  }
  Vec3 nearest_m(Eigen::Index triangle, const Vec3& to_m, const TriangleTree& tree) const {
    const auto shares = tree.barycentric(static_cast<int>(triangle), to_m);
    Vec3 at_m = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      at_m += shares.at(static_cast<std::size_t>(k)) * corner_m(triangle, k);
    }
    return at_m;
  }
  Vec3 corner_m(Eigen::Index triangle, int k) const {
    return points_m_[static_cast<std::size_t>(surface_.facets.triangles(triangle, k))];
  }
  void mark_longer(Eigen::Index triangle, double allowed_m) {
    for (int k = 0; k < 3; ++k) {
      const int from = surface_.facets.triangles(triangle, k);
      const int to = surface_.facets.triangles(triangle, (k + 1) % 3);
      if (distance_m(from, to) > allowed_m) {
        too_long_.insert(ascending(from, to));
      }
    }
  }
  // The middle of the edge from a triangle's corner k on.
  int middle_of(Eigen::Index triangle, int k) {
    constexpr std::array<std::array<double, 2>, 3> shares{{{0.5, 0.0}, {0.5, 0.5}, {0.0, 0.5}}};
    const int from = surface_.facets.triangles(triangle, k);
    const int to = surface_.facets.triangles(triangle, (k + 1) % 3);
    if (!too_long_.contains(ascending(from, to))) {
      return none;
    }
    const auto [middle, is_new] =
        middles_.try_emplace(ascending(from, to), static_cast<int>(points_m_.size()));
    if (is_new) {
      const auto& [x, y] = shares.at(static_cast<std::size_t>(k));
      points_m_.push_back(curved_.at_m(triangle, x, y));
    }
    return middle->second;
  }
  double distance_m(int a, int b) const {
    return (points_m_[static_cast<std::size_t>(a)] - points_m_[static_cast<std::size_t>(b)]).norm();
  }
  void divide(Eigen::Index triangle) {
    const std::array<int, 3> middles{middle_of(triangle, 0), middle_of(triangle, 1),
                                     middle_of(triangle, 2)};
    const auto whole = std::ranges::count(middles, none);
    // From where one edge alone is whole or divided.
    int first = 0;
    while ((whole == 1 && middles.at(static_cast<std::size_t>(first)) != none) ||
           (whole == 2 && middles.at(static_cast<std::size_t>(first)) == none)) {
      ++first;
    }
    const auto turned = [&](int k) { return static_cast<std::size_t>((first + k) % 3); };
    const auto point = [&](int k) {
      return surface_.facets.triangles(triangle, static_cast<Eigen::Index>(turned(k)));
    };
    const int a = point(0);
    const int b = point(1);
    const int c = point(2);
    const int ab = middles.at(turned(0));
    const int bc = middles.at(turned(1));
    const int ca = middles.at(turned(2));
    if (whole == 3) {
      triangles_.push_back({a, b, c});
    } else if (whole == 2) {
      add({{{a, ab, c}, {ab, b, c}}});
    } else if (whole == 1) {
      triangles_.push_back({c, ca, bc});
      distance_m(a, bc) < distance_m(b, ca) ? add({{{a, b, bc}, {a, bc, ca}}})
                                            : add({{{a, b, ca}, {b, bc, ca}}});
    } else {
      add({{{a, ab, ca}, {ab, b, bc}}});
      add({{{ca, bc, c}, {ab, bc, ca}}});
    }
  }
  void add(const std::array<std::array<int, 3>, 2>& both) {
    triangles_.insert(triangles_.end(), both.begin(), both.end());
  }

  CurvedTriangles curved_;
  const MiddleSurface& surface_;
  std::vector<Vec3> points_m_;
  std::set<Ends> too_long_;
  std::vector<std::array<int, 3>> triangles_;
  std::map<Ends, int> middles_;
};
}  // namespace

MiddleSurface divided(MiddleSurface surface, double longest_m,
                      const std::vector<FilledRegion>& regions, Eigen::Index most) {
  for (;;) {
    if (surface.facets.triangles.rows() > most) {
      throw ModelError{fmt::format(
          "mesh: shells {:.3g} m wide take over {} elements, the most that are modelled (choose a "
          "larger shell_width_m, or a surface of fewer triangles)",
          longest_m, most)};
    }
    std::optional<MiddleSurface> next = Division{surface, longest_m, regions}.divided();
    if (!next) {
      return surface;
    }
    surface = std::move(*next);
  }
}
}  // namespace tapstudy::core
