#include "protocols/surface/wrap_surface.hpp"

#include "protocols/surface/cgal_triangulation.hpp"
// CGAL's other headers follow, which include what that one changes.
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/alpha_wrap_3.h>

#include <array>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "protocols/surface/surface_job.hpp"
namespace tapstudy::protocols {
namespace {
using core::TriangleSurface;
using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

std::string packed(const TriangleSurface& surface) {
  core::PackedBytes bytes;
  put(bytes, surface);
  return bytes.take();
}

std::vector<Point> points_in(const TriangleSurface& surface) {
  std::vector<Point> points;
  for (const auto& p : surface.points_m.rowwise()) {
    points.emplace_back(p.x(), p.y(), p.z());
  }
  return points;
}

const core::ChildJob wrapping{
    "wrap a surface", [](const std::string& input) {
      core::UnpackedBytes bytes{input};
      const TriangleSurface surface = surface_in(bytes);
      const auto lengths_m = bytes.get<std::vector<double>>();
      std::vector<std::array<std::size_t, 3>> triangles;
      for (const auto& t : surface.triangles.rowwise()) {
        triangles.push_back({static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                             static_cast<std::size_t>(t[2])});
      }
      Mesh wrap;
      CGAL::alpha_wrap_3(points_in(surface), triangles, lengths_m.at(0), lengths_m.at(1), wrap);
      wrap.collect_garbage();
      return packed(surface_of(wrap));
    }};

// CGAL's own has another name in each of its versions.
struct FewEdges {
  std::size_t edges;
  template <class Cost, class Profile>
  bool operator()(const Cost& /*cost*/, const Profile& /*profile*/, std::size_t /*at_first*/,
                  std::size_t now) const {
    return now <= edges;
  }
};

const core::ChildJob simplifying{
    "simplify a surface", [](const std::string& input) {
      core::UnpackedBytes bytes{input};
      const TriangleSurface surface = surface_in(bytes);
      const auto triangles = static_cast<std::size_t>(bytes.get<std::vector<int>>().at(0));
      Mesh mesh;
      for (const Point& point : points_in(surface)) {
        mesh.add_vertex(point);
      }
      for (const auto& t : surface.triangles.rowwise()) {
        const auto corner = [&](int k) { return Mesh::Vertex_index(static_cast<unsigned>(t[k])); };
        if (mesh.add_face(corner(0), corner(1), corner(2)) == Mesh::null_face()) {
          throw core::InvalidInput{"surface: only a closed one is simplified"};
        }
      }
      // a closed surface of triangles has three edges to two of them
      namespace simplification = CGAL::Surface_mesh_simplification;
      simplification::edge_collapse(
          mesh, FewEdges{3 * triangles / 2},
          CGAL::parameters::filter(simplification::Bounded_normal_change_filter<>{}));
      mesh.collect_garbage();
      return packed(surface_of(mesh));
    }};

template <class Value>
TriangleSurface result_of(const core::ChildJob& job, const TriangleSurface& surface,
                          const std::vector<Value>& values, const std::string& what) {
  core::PackedBytes input;
  put(input, surface);
  input.put(values);
  const std::string output = core::in_bounded_child(job, input.take(), what, surface_job_limits);
  core::UnpackedBytes bytes{output};
  return surface_in(bytes);
}
}  // namespace

TriangleSurface wrapped(const TriangleSurface& surface, double distance_m, double offset_m) {
  return result_of(wrapping, surface, std::vector{distance_m, offset_m},
                   "surface: it could not be wrapped at that distance (try a larger one)");
}

TriangleSurface simplified(const TriangleSurface& surface, int max_triangles) {
  return result_of(simplifying, surface, std::vector{max_triangles},
                   "surface: it could not be simplified");
}
}  // namespace tapstudy::protocols
