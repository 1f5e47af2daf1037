#include "core/model/fixation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "core/error.hpp"
namespace tapstudy::core {
namespace {
constexpr int rim_points = 8;

void add_on_faces(const Vec3& at_m, Face face, const Bounds& body, std::vector<Vec3>& points) {
  if (face != Face::bottom) {
    points.emplace_back(at_m.x(), at_m.y(), body.high_m.z());
  }
  if (face != Face::top) {
    points.emplace_back(at_m.x(), at_m.y(), body.low_m.z());
  }
}

void add_rim(const Fixation& disc, const Bounds& body, std::vector<Vec3>& points) {
  for (int i = 0; i < rim_points; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / rim_points;
    const Vec3 out{std::cos(angle), std::sin(angle), 0.0};
    add_on_faces(disc.at_m + disc.radius_m * out, disc.face, body, points);
  }
}

void add_corners(const Vec3& low_m, const Vec3& high_m, std::vector<Vec3>& points) {
  for (int corner = 0; corner < 8; ++corner) {
    points.emplace_back((corner & 1) == 0 ? low_m.x() : high_m.x(),
                        (corner & 2) == 0 ? low_m.y() : high_m.y(),
                        (corner & 4) == 0 ? low_m.z() : high_m.z());
  }
}

std::vector<Vec3> wanted_points(const Fixation& fixation, const Bounds& body) {
  std::vector<Vec3> points;
  switch (fixation.shape) {
    case RegionShape::disc:
      add_on_faces(fixation.at_m, fixation.face, body, points);
      add_rim(fixation, body, points);
      break;
    case RegionShape::vertex:
      add_on_faces(fixation.at_m, fixation.face, body, points);
      break;
    case RegionShape::box:
      add_corners(fixation.low_m.cwiseMax(body.low_m), fixation.high_m.cwiseMin(body.high_m),
                  points);
      break;
    case RegionShape::ball:
    case RegionShape::side:
      break;
  }
  return points;
}

// Snaps points within rounding of a face onto it.
Vec3 onto_faces(Vec3 point, const Bounds& body) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const double face : {body.low_m[axis], body.high_m[axis]}) {
      if (std::abs(point[axis] - face) <= body.snap_m()) {
        point[axis] = face;
      }
    }
  }
  return point;
}

bool is_on_boundary(const Vec3& point, const Bounds& body) {
  const bool is_inside =
      ((point - body.low_m).array() >= 0.0).all() && ((body.high_m - point).array() >= 0.0).all();
  const bool touches =
      ((point - body.low_m).array() == 0.0).any() || ((body.high_m - point).array() == 0.0).any();
  return is_inside && touches;
}
}  // namespace

std::vector<Vec3> points_to_mesh(const std::vector<Fixation>& fixations, const Shape& shape) {
  std::vector<Vec3> points;
  if (!std::holds_alternative<Box>(shape)) {
    return points;
  }
  const Bounds body = bounds(shape);
  for (const Fixation& fixation : fixations) {
    for (const Vec3& wanted : wanted_points(fixation, body)) {
      const Vec3 point = onto_faces(wanted, body);
      if (is_on_boundary(point, body)) {
        points.push_back(point);
      }
    }
  }
  return points;
}

namespace {
// A surface from a file has only its own points: the node nearest to a vertex fixation may be this
// far off, as a fraction of the body's diagonal, because coordinates are typed with few digits.
constexpr double vertex_reach = 1e-3;

bool is_on_face(double z_m, Face face, const Bounds& body) {
  const bool on_top = std::abs(z_m - body.high_m.z()) <= body.snap_m();
  const bool on_bottom = std::abs(z_m - body.low_m.z()) <= body.snap_m();
  switch (face) {
    case Face::top:
      return on_top;
    case Face::bottom:
      return on_bottom;
    case Face::both:
      return on_top || on_bottom;
    case Face::through:
      return true;
  }
  return false;
}

bool is_on_side(const Vec3& node_m, Side side, const Bounds& body, double snap_m) {
  const auto number = static_cast<int>(side);
  const Eigen::Index axis = number / 2;
  const double at = number % 2 == 0 ? body.low_m[axis] : body.high_m[axis];
  return std::abs(node_m[axis] - at) <= snap_m;
}

// The rim of a bent sheet lies on a plane as nearly as its normals are known.
double snap_of(const Shape& shape) {
  constexpr double of_thickness = 0.01;
  const auto* const solid = std::get_if<Solid>(&shape);
  const bool is_bent = solid != nullptr && solid->sheet();
  return std::max(bounds(shape).snap_m(),
                  is_bent ? of_thickness * solid->sheet()->thickness_m : 0.0);
}

bool selects_node(const Fixation& fixation, const Vec3& node_m, const Bounds& body, double snap_m) {
  switch (fixation.shape) {
    case RegionShape::vertex:
    case RegionShape::disc:
      return (node_m - fixation.at_m).head<2>().norm() <= fixation.radius_m + snap_m &&
             is_on_face(node_m.z(), fixation.face, body);
    case RegionShape::ball:
      return (node_m - fixation.at_m).norm() <= fixation.radius_m + snap_m;
    case RegionShape::box:
      return ((node_m - fixation.low_m).array() >= -snap_m).all() &&
             ((fixation.high_m - node_m).array() >= -snap_m).all();
    case RegionShape::side:
      return is_on_side(node_m, fixation.side, body, snap_m);
  }
  return false;
}

// Of a solid, searches the corners of surface triangles only, not interior and mid-side nodes; a
// sheet has nodes in its middle, too.
Eigen::Index nearest_node(const TetMesh& mesh, const Solid& solid, const Vec3& at_m) {
  const Eigen::ArrayXd squares_m2 =
      (mesh.nodes_m.rowwise() - at_m.transpose()).rowwise().squaredNorm();
  Eigen::Index nearest = 0;
  if (solid.sheet()) {
    squares_m2.minCoeff(&nearest);
    return nearest;
  }
  const auto corners = mesh.surface.leftCols<3>().reshaped();
  return *std::ranges::min_element(corners, {}, [&](int node) { return squares_m2[node]; });
}

std::vector<Eigen::Index> selected_nodes(const Fixation& fixation, const TetMesh& mesh,
                                         const Shape& shape) {
  const Bounds body = bounds(shape);
  const double snap_m = snap_of(shape);
  std::vector<Eigen::Index> nodes;
  const auto* const solid = std::get_if<Solid>(&shape);
  if (fixation.shape == RegionShape::vertex && solid != nullptr) {
    const Eigen::Index nearest = nearest_node(mesh, *solid, fixation.at_m);
    const double distance_m = (mesh.nodes_m.row(nearest).transpose() - fixation.at_m).norm();
    if (distance_m <= vertex_reach * body.size_m().norm()) {
      nodes.push_back(nearest);
    }
    return nodes;
  }
  for (Eigen::Index node = 0; node < mesh.nodes_m.rows(); ++node) {
    if (selects_node(fixation, mesh.nodes_m.row(node).transpose(), body, snap_m)) {
      nodes.push_back(node);
    }
  }
  return nodes;
}

template <class Element>
bool holds_all(const std::vector<bool>& is_held, const Element& corners) {
  return std::ranges::all_of(corners,
                             [&](int node) { return is_held[static_cast<std::size_t>(node)]; });
}

double held_area_m2(const TetMesh& mesh, const std::vector<bool>& is_held) {
  double area_m2 = 0.0;
  for (Eigen::Index i = 0; i < mesh.surface.rows(); ++i) {
    const std::array<int, 3> corners{mesh.surface(i, 0), mesh.surface(i, 1), mesh.surface(i, 2)};
    if (holds_all(is_held, corners)) {
      area_m2 += triangle_area_m2(mesh, i);
    }
  }
  return area_m2;
}

double held_volume_m3(const TetMesh& mesh, const std::vector<bool>& is_held) {
  double volume_m3 = 0.0;
  for (Eigen::Index i = 0; i < mesh.tets.rows(); ++i) {
    const std::array<int, 4> corners{mesh.tets(i, 0), mesh.tets(i, 1), mesh.tets(i, 2),
                                     mesh.tets(i, 3)};
    if (holds_all(is_held, corners)) {
      volume_m3 += tet_volume_m3(mesh, i);
    }
  }
  return volume_m3;
}

std::string described(const Fixation& fixation) {
  const auto text = [](const Vec3& v) { return fmt::format("({}, {}, {})", v.x(), v.y(), v.z()); };
  switch (fixation.shape) {
    case RegionShape::vertex:
      return fmt::format("vertex at {} m", text(fixation.at_m));
    case RegionShape::disc:
      return fmt::format("disc of radius {} m at ({}, {}) m", fixation.radius_m, fixation.at_m.x(),
                         fixation.at_m.y());
    case RegionShape::ball:
      return fmt::format("ball of radius {} m at {} m", fixation.radius_m, text(fixation.at_m));
    case RegionShape::box:
      return fmt::format("box from {} to {} m", text(fixation.low_m), text(fixation.high_m));
    case RegionShape::side:
      return fmt::format("side '{}'", name_in(side_names, fixation.side));
  }
  return {};
}

// Where a region round a point had to be; empty of others.
std::string nearest_to(const Fixation& fixation, const TetMesh& mesh, const Shape& shape) {
  const auto* const solid = std::get_if<Solid>(&shape);
  const bool is_round_point =
      fixation.shape == RegionShape::vertex || fixation.shape == RegionShape::ball;
  if (solid == nullptr || !is_round_point) {
    return {};
  }
  const auto node_m = mesh.nodes_m.row(nearest_node(mesh, *solid, fixation.at_m));
  return fmt::format("; the nearest is ({:.4g}, {:.4g}, {:.4g}) m", node_m.x(), node_m.y(),
                     node_m.z());
}
}  // namespace

std::vector<Eigen::Index> nodes_of(const Fixation& fixation, const TetMesh& mesh,
                                   const Shape& shape, std::string_view whose) {
  std::vector<Eigen::Index> nodes = selected_nodes(fixation, mesh, shape);
  if (nodes.empty()) {
    const Bounds body = bounds(shape);
    throw ModelError{fmt::format(
        "{}: the {} touches no node of the body (x from {:.4g} to {:.4g} m, y from {:.4g} "
        "to {:.4g} m, z from {:.4g} to {:.4g} m){}",
        whose, described(fixation), body.low_m.x(), body.high_m.x(), body.low_m.y(),
        body.high_m.y(), body.low_m.z(), body.high_m.z(), nearest_to(fixation, mesh, shape))};
  }
  return nodes;
}

SurfaceRegion region_of(const Fixation& fixation, const TetMesh& mesh, const Shape& shape) {
  const bool is_point = fixation.shape == RegionShape::vertex;
  return {nodes_of(fixation, mesh, shape),
          [fixation, is_point, body = bounds(shape), snap_m = snap_of(shape)](const Vec3& at_m) {
            return !is_point && selects_node(fixation, at_m, body, snap_m);
          }};
}

std::vector<bool> constrained_dofs(const TetMesh& mesh, const Shape& shape,
                                   const std::vector<Fixation>& fixations) {
  std::vector<bool> held(static_cast<std::size_t>(3 * mesh.nodes_m.rows()), false);
  for (const Fixation& fixation : fixations) {
    const auto nodes = nodes_of(fixation, mesh, shape);
    for (const Eigen::Index node : fixation.springs_n_per_m ? std::vector<Eigen::Index>{} : nodes) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t dof = 3 * static_cast<std::size_t>(node) + axis;
        held[dof] = held[dof] || fixation.constrained_axes.at(axis);
      }
    }
  }
  if (std::find(held.begin(), held.end(), false) == held.end()) {
    throw ModelError{"fixation: every node of the body is held, nothing is left free to vibrate"};
  }
  return held;
}

bool can_hold_a_solid(const Fixation& fixation) {
  switch (fixation.shape) {
    case RegionShape::vertex:
      return false;
    case RegionShape::box:
      return ((fixation.high_m - fixation.low_m).array() > 0.0).count() >= 2;
    case RegionShape::disc:
    case RegionShape::ball:
    case RegionShape::side:
      break;
  }
  return true;
}

std::vector<double> held_areas_m2(const TetMesh& mesh, const Shape& shape,
                                  const std::vector<Fixation>& fixations) {
  std::vector<double> areas_m2;
  for (const Fixation& fixation : fixations) {
    const std::vector<bool> is_held = mesh.marked(selected_nodes(fixation, mesh, shape));
    const double area_m2 = held_area_m2(mesh, is_held);
    areas_m2.push_back(area_m2 > 0.0 ? area_m2
                                     : std::pow(held_volume_m3(mesh, is_held), 2.0 / 3.0));
  }
  return areas_m2;
}

namespace {
// Of triangles between neighbouring nodes, mid-side nodes included.
double spanned_area_m2(const TetMesh& mesh, const std::vector<bool>& is_held) {
  if (mesh.order() == 1) {
    return held_area_m2(mesh, is_held);
  }
  constexpr std::array<std::array<int, 3>, 4> quarters{
      {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
  double area_m2 = 0.0;
  for (Eigen::Index i = 0; i < mesh.surface.rows(); ++i) {
    const auto held = std::ranges::count_if(quarters, [&](const std::array<int, 3>& quarter) {
      return std::ranges::all_of(quarter, [&](int node) {
        return is_held[static_cast<std::size_t>(mesh.surface(i, node))];
      });
    });
    area_m2 += 0.25 * static_cast<double>(held) * triangle_area_m2(mesh, i);
  }
  return area_m2;
}
}  // namespace

std::vector<std::string> held_in_part(const TetMesh& mesh, const Shape& shape,
                                      const std::vector<Fixation>& fixations) {
  constexpr double nearly_all = 0.75;
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < fixations.size(); ++i) {
    const Fixation& fixation = fixations[i];
    if (fixation.shape == RegionShape::side || fixation.springs_n_per_m) {
      continue;
    }
    const SurfaceRegion region = region_of(fixation, mesh, shape);
    const double whole_m2 = area_within_m2(mesh, region);
    const double held_m2 = spanned_area_m2(mesh, mesh.marked(region.nodes));
    if (held_m2 < nearly_all * whole_m2) {
      sentences.push_back(
          fmt::format("fixation {}, the {}, holds {} nodes, which span {:.2g} of the {:.2g} m2 of "
                      "the surface in it",
                      i + 1, described(fixation), region.nodes.size(), held_m2, whole_m2));
    }
  }
  return sentences;
}

std::vector<SpringSupport> spring_supports(const TetMesh& mesh, const Shape& shape,
                                           const std::vector<Fixation>& fixations) {
  std::vector<SpringSupport> supports;
  for (const Fixation& fixation : fixations) {
    if (fixation.springs_n_per_m) {
      supports.push_back({region_of(fixation, mesh, shape), *fixation.springs_n_per_m});
    }
  }
  return supports;
}

bool is_on_springs(const std::vector<Fixation>& fixations) {
  return std::ranges::any_of(
      fixations, [](const Fixation& fixation) { return fixation.springs_n_per_m.has_value(); });
}

std::string content_key(const Fixation& fixation) {
  const auto exact = [](const Vec3& v) {
    return fmt::format("{:a},{:a},{:a}", v.x(), v.y(), v.z());
  };
  const std::string held = fixation.springs_n_per_m
                               ? exact(*fixation.springs_n_per_m)
                               : fmt::format("{}", fmt::join(fixation.constrained_axes, ""));
  return fmt::format("region{}({},{:a},{},{},{},{},{})", static_cast<int>(fixation.shape),
                     exact(fixation.at_m), fixation.radius_m, static_cast<int>(fixation.face),
                     exact(fixation.low_m), exact(fixation.high_m), static_cast<int>(fixation.side),
                     held);
}
}  // namespace tapstudy::core
