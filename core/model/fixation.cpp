#include "core/model/fixation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
namespace tapstudy::core {
namespace {
constexpr int rim_points = 8;

bool is_on_face(double z_m, Face face, const Box& box) {
  const bool on_top = std::abs(z_m - box.high_m().z()) <= box.snap_m();
  const bool on_bottom = std::abs(z_m - box.low_m().z()) <= box.snap_m();
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

bool holds_node(const Fixation& fixation, const Vec3& node_m, const Box& box) {
  const double reach_m = fixation.radius_m + box.snap_m();
  return (node_m.head<2>() - fixation.at_m).norm() <= reach_m &&
         is_on_face(node_m.z(), fixation.face, box);
}

std::vector<Eigen::Vector2d> sideways_points(const Fixation& fixation) {
  std::vector<Eigen::Vector2d> points{fixation.at_m};
  if (fixation.shape == RegionShape::disc) {
    for (int i = 0; i < rim_points; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / rim_points;
      points.emplace_back(fixation.at_m +
                          fixation.radius_m * Eigen::Vector2d{std::cos(angle), std::sin(angle)});
    }
  }
  return points;
}

std::vector<double> heights_m(Face face, const Box& box) {
  switch (face) {
    case Face::top:
      return {box.high_m().z()};
    case Face::bottom:
      return {box.low_m().z()};
    case Face::both:
    case Face::through:
      return {box.high_m().z(), box.low_m().z()};
  }
  return {};
}

// A point within rounding of an edge is on it.
Eigen::Vector2d onto_edges(Eigen::Vector2d point, const Eigen::Vector2d& half_m, double snap_m) {
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    if (std::abs(std::abs(point[axis]) - half_m[axis]) <= snap_m) {
      point[axis] = std::copysign(half_m[axis], point[axis]);
    }
  }
  return point;
}

std::string described(const Fixation& fixation) {
  return fmt::format("{} at ({}, {}) m",
                     fixation.shape == RegionShape::vertex
                         ? std::string{"vertex"}
                         : fmt::format("disc of radius {} m", fixation.radius_m),
                     fixation.at_m.x(), fixation.at_m.y());
}
}  // namespace

std::vector<Vec3> points_to_mesh(const std::vector<Fixation>& fixations, const Box& box) {
  std::vector<Vec3> points;
  const Eigen::Vector2d half_m = box.high_m().head<2>();
  for (const Fixation& fixation : fixations) {
    for (const Eigen::Vector2d& sideways : sideways_points(fixation)) {
      if ((sideways.cwiseAbs().array() > half_m.array() + box.snap_m()).any()) {
        continue;
      }
      const Eigen::Vector2d inside = onto_edges(sideways, half_m, box.snap_m());
      for (const double height : heights_m(fixation.face, box)) {
        points.emplace_back(inside.x(), inside.y(), height);
      }
    }
  }
  return points;
}

std::vector<bool> held_dofs(const TetMesh& mesh, const Box& box,
                            const std::vector<Fixation>& fixations) {
  std::vector<bool> held(static_cast<std::size_t>(3 * mesh.nodes_m.rows()), false);
  for (const Fixation& fixation : fixations) {
    bool touches = false;
    for (Eigen::Index node = 0; node < mesh.nodes_m.rows(); ++node) {
      if (!holds_node(fixation, mesh.nodes_m.row(node).transpose(), box)) {
        continue;
      }
      touches = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t dof = 3 * static_cast<std::size_t>(node) + axis;
        held[dof] = held[dof] || fixation.holds.at(axis);
      }
    }
    if (!touches) {
      throw ModelError{
          fmt::format("fixation: the {} touches no node of the plate (x in ±{} m, y in ±{} m)",
                      described(fixation), box.high_m().x(), box.high_m().y())};
    }
  }
  if (std::find(held.begin(), held.end(), false) == held.end()) {
    throw ModelError{"fixation: every node of the plate is held, nothing is left free to vibrate"};
  }
  return held;
}
}  // namespace tapstudy::core
