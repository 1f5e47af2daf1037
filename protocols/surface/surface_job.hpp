#pragma once
#include <span>
#include <vector>

#include "core/geometry/triangle_surface.hpp"
#include "core/process/bounded_child.hpp"
namespace tapstudy::protocols {
// CGAL's algorithms on surfaces run in a process of their own: given what is no closed manifold
// some of them crash, or take all memory.
inline constexpr core::ChildLimits surface_job_limits{300, 4'000'000'000};

inline void put(core::PackedBytes& bytes, const core::TriangleSurface& surface) {
  bytes.put(std::span{surface.points_m.data(), static_cast<std::size_t>(surface.points_m.size())});
  bytes.put(
      std::span{surface.triangles.data(), static_cast<std::size_t>(surface.triangles.size())});
}

inline core::TriangleSurface surface_in(core::UnpackedBytes& bytes) {
  const auto coordinates = bytes.get<std::vector<double>>();
  const auto corners = bytes.get<std::vector<int>>();
  core::TriangleSurface surface;
  surface.points_m = Eigen::Map<const core::TriangleSurface::Points>{
      coordinates.data(), static_cast<Eigen::Index>(coordinates.size() / 3), 3};
  surface.triangles = Eigen::Map<const core::TriangleSurface::Triangles>{
      corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3};
  return surface;
}

// The points and triangles of a mesh of CGAL's.
template <class Mesh>
core::TriangleSurface surface_of(const Mesh& mesh) {
  core::TriangleSurface surface;
  surface.points_m.resize(static_cast<Eigen::Index>(mesh.num_vertices()), 3);
  surface.triangles.resize(static_cast<Eigen::Index>(mesh.number_of_faces()), 3);
  for (const auto vertex : mesh.vertices()) {
    const auto& p = mesh.point(vertex);
    surface.points_m.row(static_cast<Eigen::Index>(vertex.idx())) << p.x(), p.y(), p.z();
  }
  Eigen::Index row = 0;
  for (const auto face : mesh.faces()) {
    Eigen::Index k = 0;
    for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face))) {
      surface.triangles(row, k++) = static_cast<int>(vertex.idx());
    }
    ++row;
  }
  return surface;
}
}  // namespace tapstudy::protocols
