#include "protocols/surface/cut_polygon.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2_algorithms.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <Eigen/Geometry>
#include <set>
#include <utility>
namespace tapstudy::protocols {
namespace {
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertices = CGAL::Triangulation_vertex_base_with_info_2<std::size_t, Kernel>;
using Faces = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<Vertices, Faces>,
    CGAL::No_constraint_intersection_tag>;
using Outline = std::vector<Kernel::Point_2>;

// Newell's method: twice the area along the normal, of any closed polygon. From its first corner,
// so that no digits are lost far from the origin.
core::Vec3 doubled_area(const std::vector<core::Vec3>& corners) {
  core::Vec3 sum = core::Vec3::Zero();
  for (std::size_t i = 2; i < corners.size(); ++i) {
    sum += (corners[i - 1] - corners.front()).cross(corners[i] - corners.front());
  }
  return sum;
}

// Two coordinates of each corner, unchanged and thus exact, counterclockwise.
Outline seen_from_outside(const std::vector<core::Vec3>& corners) {
  const core::Vec3 area = doubled_area(corners);
  Eigen::Index along = 0;
  area.cwiseAbs().maxCoeff(&along);
  Eigen::Index right = (along + 1) % 3;
  Eigen::Index up = (along + 2) % 3;
  if (area[along] < 0.0) {
    std::swap(right, up);
  }
  Outline outline;
  for (const core::Vec3& corner : corners) {
    outline.emplace_back(corner[right], corner[up]);
  }
  return outline;
}

Triangulation triangulated(const Outline& outline) {
  Triangulation triangulation;
  std::vector<Triangulation::Vertex_handle> corners;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    corners.push_back(triangulation.insert(outline[i]));
    corners.back()->info() = i;
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    triangulation.insert_constraint(corners[i], corners[(i + 1) % corners.size()]);
  }
  return triangulation;
}

// What is reached from infinity without crossing the outline.
std::set<Triangulation::Face_handle> outer_faces(const Triangulation& triangulation) {
  std::set<Triangulation::Face_handle> outer{triangulation.infinite_face()};
  std::vector<Triangulation::Face_handle> waiting{triangulation.infinite_face()};
  while (!waiting.empty()) {
    const Triangulation::Face_handle face = waiting.back();
    waiting.pop_back();
    for (int side = 0; side < 3; ++side) {
      const Triangulation::Face_handle next = face->neighbor(side);
      if (!face->is_constrained(side) && outer.insert(next).second) {
        waiting.push_back(next);
      }
    }
  }
  return outer;
}
}  // namespace

std::vector<std::array<std::size_t, 3>> cut_polygon(const std::vector<core::Vec3>& corners) {
  const Outline outline = seen_from_outside(corners);
  if (!CGAL::is_simple_2(outline.begin(), outline.end(), Kernel{}) ||
      CGAL::orientation_2(outline.begin(), outline.end(), Kernel{}) != CGAL::COUNTERCLOCKWISE) {
    return {};
  }
  const Triangulation triangulation = triangulated(outline);
  const auto outer = outer_faces(triangulation);
  std::vector<std::array<std::size_t, 3>> triangles;
  for (const Triangulation::Face_handle face : triangulation.finite_face_handles()) {
    if (!outer.contains(face)) {
      triangles.push_back(
          {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    }
  }
  return triangles;
}
}  // namespace tapstudy::protocols
