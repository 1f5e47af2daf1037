#include "protocols/surface/check_surface.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/model/shells/sheet_body.hpp"
#include "protocols/surface/flat_triangle.hpp"
namespace tapstudy::protocols {
namespace {
namespace pmp = CGAL::Polygon_mesh_processing;
using core::InvalidInput;
using core::TriangleSurface;
using core::Vec3;
using Mesh = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;
constexpr double min_size_m = 1e-3;
constexpr double max_size_m = 10.0;
constexpr double no_volume = 1e-9;  // as a fraction of the bounding cube's

std::string place(const TriangleSurface& surface, int point) {
  const auto p = surface.points_m.row(point);
  return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", p.x(), p.y(), p.z());
}

void check_size(const TriangleSurface& surface) {
  if (!surface.points_m.allFinite()) {
    throw InvalidInput{"surface: a coordinate is not a finite number"};
  }
  const Vec3 size = bounds(surface).size_m();
  if (size.maxCoeff() > max_size_m || size.maxCoeff() < min_size_m) {
    throw InvalidInput{fmt::format(
        "surface: it is {:.4g} × {:.4g} × {:.4g} m (from {} to {} m; is metres_per_unit right?)",
        size.x(), size.y(), size.z(), min_size_m, max_size_m)};
  }
}

void check_areas(const TriangleSurface& surface) {
  for (Eigen::Index i = 0; i < surface.triangles.rows(); ++i) {
    const auto corner = [&](Eigen::Index k) -> Vec3 {
      return surface.points_m.row(surface.triangles(i, k));
    };
    if (has_no_area(corner(0), corner(1), corner(2))) {
      throw SurfaceFault{fmt::format("surface: triangle {} at {} has no area", i,
                                     place(surface, surface.triangles(i, 0)))};
    }
    if (is_flat_cap(corner(0), corner(1), corner(2))) {
      throw SurfaceFault{
          fmt::format("surface: triangle {} at {} is flat: a corner lies on the opposite side", i,
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

enum class Rims { closed, open };

void check_edges(const TriangleSurface& surface, Rims rims,
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
      if (rims == Rims::open) {
        continue;
      }
      throw SurfaceFault{"surface: it is open (has a hole) " + where};
    }
    if (triangles.size() + back == 2) {
      throw SurfaceFault{"surface: two neighbouring triangles face opposite ways " + where};
    }
    throw SurfaceFault{
        fmt::format("surface: {} triangles meet (two may) {}", triangles.size() + back, where)};
  }
}

Mesh mesh_of(const TriangleSurface& surface) {
  Mesh mesh;
  for (const auto& p : surface.points_m.rowwise()) {
    mesh.add_vertex({p.x(), p.y(), p.z()});
  }
  for (const auto& t : surface.triangles.rowwise()) {
    const auto corner = [&](int k) { return Mesh::Vertex_index(static_cast<unsigned>(t[k])); };
    if (mesh.add_face(corner(0), corner(1), corner(2)) == Mesh::null_face()) {
      throw SurfaceFault{fmt::format(
          "surface: parts of it meet in a single point only, at {} (a body is one closed shell)",
          place(surface, t[0]))};
    }
  }
  return mesh;
}

// Open ones enclose nothing, and those that cross are not one within the other.
bool has_nested_pieces(const Mesh& mesh) {
  if (!CGAL::is_closed(mesh)) {
    return false;
  }
  std::vector<std::size_t> volume(mesh.number_of_faces());
  const auto volume_of =
      boost::make_iterator_property_map(volume.begin(), get(boost::face_index, mesh));
  std::vector<std::size_t> levels;
  pmp::volume_connected_components(mesh, volume_of,
                                   CGAL::parameters::nesting_levels(std::ref(levels))
                                       .do_orientation_tests(false)
                                       .do_self_intersection_tests(true));
  return std::ranges::any_of(levels, [](std::size_t level) { return level > 0; });
}

void check_one_piece(const TriangleSurface& surface, const Mesh& mesh) {
  std::vector<std::size_t> piece(mesh.number_of_faces());
  const auto piece_of =
      boost::make_iterator_property_map(piece.begin(), get(boost::face_index, mesh));
  if (pmp::connected_components(mesh, piece_of) == 1) {
    return;
  }
  const auto other = std::ranges::find_if(piece, [](std::size_t number) { return number != 0; });
  const bool have_cavity = has_nested_pieces(mesh);
  throw SeveralPieces{
      fmt::format(
          "surface: it is in several pieces, one at {}, another at {} (a body is one closed "
          "shell{})",
          place(surface, surface.triangles(0, 0)),
          place(surface, surface.triangles(other - piece.begin(), 0)),
          have_cavity ? "; a piece within another is a cavity, which a body here cannot have" : ""),
      have_cavity};
}

void check_volume(const TriangleSurface& surface, const Mesh& mesh) {
  const double volume = volume_m3(surface);
  const double cube = std::pow(bounds(surface).size_m().maxCoeff(), 3);
  if (!(std::abs(volume) > no_volume * cube)) {
    throw SurfaceFault{fmt::format("surface: it encloses no volume ({:.3g} m³)", volume)};
  }
  if (!pmp::is_outward_oriented(mesh)) {
    throw SurfaceFault{"surface: its triangles face inward (reverse the orientation of all)"};
  }
}

void check_crossings(const TriangleSurface& surface, const Mesh& mesh) {
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> crossings;
  pmp::self_intersections(mesh, std::back_inserter(crossings));
  if (crossings.empty()) {
    return;
  }
  const auto first_corner = [&](Mesh::Face_index face) {
    return place(surface, surface.triangles(static_cast<Eigen::Index>(face.idx()), 0));
  };
  const auto [one, other] = crossings.front();
  throw SurfaceFault{
      fmt::format("surface: it runs through itself: triangle {} at {} meets triangle {} at {}",
                  one.idx(), first_corner(one), other.idx(), first_corner(other))};
}
}  // namespace

void check_count(const TriangleSurface& surface) {
  if (surface.triangles.rows() > max_triangles) {
    throw SurfaceFault{fmt::format("surface: it has {} triangles (at most {})",
                                   surface.triangles.rows(), max_triangles)};
  }
}

// First, with location, defects that preclude building a mesh; then those CGAL finds in the mesh.
void check_surface(const TriangleSurface& surface) {
  check_size(surface);
  check_areas(surface);
  check_edges(surface, Rims::closed, triangles_along(surface));
  const Mesh mesh = mesh_of(surface);
  check_one_piece(surface, mesh);
  check_volume(surface, mesh);
  check_crossings(surface, mesh);
}

core::Solid checked_sheet(core::TriangleSurface middle, double thickness_m) {
  if (middle.triangles.rows() > core::max_sheet_triangles) {
    throw InvalidInput{fmt::format("surface: it has {} triangles (with thickness_m at most {})",
                                   middle.triangles.rows(), core::max_sheet_triangles)};
  }
  check_size(middle);
  check_areas(middle);
  check_edges(middle, Rims::open, triangles_along(middle));
  const Mesh mesh = mesh_of(middle);
  check_one_piece(middle, mesh);
  const double width_m = std::sqrt(pmp::area(mesh));
  if (!(width_m >= least_sheet_width * thickness_m)) {
    throw InvalidInput{
        fmt::format("surface: the root of its area is {:.3g} m, less than {} times its thickness_m "
                    "(such a body is "
                    "a solid: give its closed surface, without thickness_m)",
                    width_m, least_sheet_width)};
  }
  core::Solid body = core::sheet_body(std::move(middle), thickness_m);
  try {
    check_crossings(body.surface(), mesh_of(body.surface()));
  } catch (const SurfaceFault& fault) {
    throw InvalidInput{fmt::format(
        "the faces of the sheet, half of thickness_m beside the surface: {}", fault.what())};
  }
  return body;
}
}  // namespace tapstudy::protocols
