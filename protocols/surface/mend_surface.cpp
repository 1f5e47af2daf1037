#include "protocols/surface/mend_surface.hpp"

#include "protocols/surface/cgal_triangulation.hpp"
// CGAL's other headers follow, which include what that one changes.
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/Euler_operations.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include "core/geometry/triangle_tree.hpp"
#include "core/model/shape/shape.hpp"
#include "protocols/surface/flat_triangle.hpp"
#include "protocols/surface/surface_job.hpp"
#include "protocols/surface/surface_points.hpp"
namespace tapstudy::protocols {
namespace {
namespace pmp = CGAL::Polygon_mesh_processing;
using core::TriangleSurface;
using core::Vec3;
using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Face = Mesh::Face_index;
using Halfedge = Mesh::Halfedge_index;
using Vertex = Mesh::Vertex_index;

// Triangles of three different corners, each once, whichever way round.
std::vector<std::vector<std::size_t>> distinct_triangles(const TriangleSurface& surface) {
  std::vector<std::vector<std::size_t>> triangles;
  std::set<std::array<int, 3>> known;
  for (const auto& t : surface.triangles.rowwise()) {
    std::array<int, 3> corners{t[0], t[1], t[2]};
    std::ranges::sort(corners);
    const bool is_triangle = corners[0] != corners[1] && corners[1] != corners[2];
    if (is_triangle && known.insert(corners).second) {
      triangles.push_back({static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                           static_cast<std::size_t>(t[2])});
    }
  }
  return triangles;
}

Mesh oriented_mesh(const TriangleSurface& surface) {
  std::vector<Point> points;
  for (const auto& p : surface.points_m.rowwise()) {
    points.emplace_back(p.x(), p.y(), p.z());
  }
  auto triangles = distinct_triangles(surface);
  pmp::orient_polygon_soup(points, triangles);
  Mesh mesh;
  for (const Point& point : points) {
    mesh.add_vertex(point);
  }
  for (const auto& t : triangles) {
    const auto corner = [&](std::size_t k) { return Vertex(static_cast<unsigned>(t[k])); };
    mesh.add_face(corner(0), corner(1), corner(2));
  }
  return mesh;
}

Vec3 corner_m(const Mesh& mesh, Vertex vertex) {
  const Point& p = mesh.point(vertex);
  return {p.x(), p.y(), p.z()};
}

// From the longest side, against which a flat triangle's third corner lies.
Halfedge longest_side(const Mesh& mesh, Face face) {
  Halfedge longest = mesh.halfedge(face);
  const auto length = [&](Halfedge h) {
    return (corner_m(mesh, mesh.target(h)) - corner_m(mesh, mesh.source(h))).squaredNorm();
  };
  for (const Halfedge h : mesh.halfedges_around_face(longest)) {
    longest = length(h) > length(longest) ? h : longest;
  }
  return longest;
}

bool is_flat(const Mesh& mesh, Face face) {
  const Halfedge h = mesh.halfedge(face);
  const Vec3 a = corner_m(mesh, mesh.source(h));
  const Vec3 b = corner_m(mesh, mesh.target(h));
  const Vec3 c = corner_m(mesh, mesh.target(mesh.next(h)));
  return has_no_area(a, b, c) || is_flat_cap(a, b, c);
}

// A flat triangle and its neighbour along the longest side are two others of the same four corners,
// and without a neighbour there it covers nothing. False: nothing was changed.
bool replace_flat(Mesh& mesh, Face face) {
  const Halfedge side = longest_side(mesh, face);
  const Halfedge other = mesh.opposite(side);
  if (mesh.is_border(other)) {
    CGAL::Euler::remove_face(side, mesh);
    return true;
  }
  const Vertex tip = mesh.target(mesh.next(side));
  const Vertex opposite_tip = mesh.target(mesh.next(other));
  if (tip == opposite_tip || mesh.halfedge(tip, opposite_tip) != Mesh::null_halfedge()) {
    return false;
  }
  CGAL::Euler::flip_edge(side, mesh);
  return true;
}

void replace_flat_triangles(Mesh& mesh) {
  constexpr int most_rounds = 20;
  bool is_changed = true;
  for (int round = 0; is_changed && round < most_rounds; ++round) {
    is_changed = false;
    const std::vector<Face> faces{mesh.faces_begin(), mesh.faces_end()};
    for (const Face face : faces) {
      if (!mesh.is_removed(face) && is_flat(mesh, face)) {
        is_changed = replace_flat(mesh, face) || is_changed;
      }
    }
  }
}

double area_m2(const Mesh& mesh, Face face) {
  const Halfedge h = mesh.halfedge(face);
  const Vec3 a = corner_m(mesh, mesh.source(h));
  return 0.5 * (corner_m(mesh, mesh.target(h)) - a)
                   .cross(corner_m(mesh, mesh.target(mesh.next(h))) - a)
                   .norm();
}

TriangleSurface surface_of_faces(const Mesh& mesh, const std::vector<Face>& faces) {
  TriangleSurface surface;
  surface.points_m.resize(3 * static_cast<Eigen::Index>(faces.size()), 3);
  surface.triangles.resize(static_cast<Eigen::Index>(faces.size()), 3);
  Eigen::Index row = 0;
  for (const Face face : faces) {
    for (const Vertex vertex : mesh.vertices_around_face(mesh.halfedge(face))) {
      surface.points_m.row(row) = corner_m(mesh, vertex).transpose();
      surface.triangles(row / 3, row % 3) = static_cast<int>(row);
      ++row;
    }
  }
  return surface;
}

// The faces of each piece, the piece of the largest area first.
std::vector<std::vector<Face>> pieces_of(Mesh& mesh) {
  auto [piece_of, is_new] = mesh.add_property_map<Face, std::size_t>("f:piece", 0);
  std::vector<std::vector<Face>> pieces(pmp::connected_components(mesh, piece_of));
  std::vector<double> areas(pieces.size(), 0.0);
  for (const Face face : mesh.faces()) {
    pieces[piece_of[face]].push_back(face);
    areas[piece_of[face]] += area_m2(mesh, face);
  }
  const auto largest = std::ranges::max_element(areas) - areas.begin();
  std::swap(pieces.front(), pieces[static_cast<std::size_t>(largest)]);
  return pieces;
}

bool is_near(const TriangleSurface& piece, const core::TriangleTree& other, double near_m) {
  bool is_found = false;
  visit_points(piece, near_m, [&](const Vec3& at_m) {
    is_found = other.is_near(at_m, near_m);
    return !is_found;
  });
  return is_found;
}

// Which pieces are near the first, or near another one that is.
std::vector<char> near_first(const std::vector<TriangleSurface>& pieces, double near_m) {
  std::vector<char> is_kept(pieces.size(), 0);
  std::vector<std::size_t> waiting{0};
  is_kept[0] = 1;
  while (near_m > 0.0 && !waiting.empty()) {
    const TriangleSurface from = parted(pieces[waiting.back()]);
    waiting.pop_back();
    if (from.triangles.rows() == 0) {
      continue;
    }
    const core::TriangleTree tree{from};
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (is_kept[i] == 0 && is_near(pieces[i], tree, near_m)) {
        is_kept[i] = 1;
        waiting.push_back(i);
      }
    }
  }
  return is_kept;
}

// Returns how many pieces were dropped.
int keep_largest_piece(Mesh& mesh, double near_m) {
  const auto pieces = pieces_of(mesh);
  if (pieces.size() < 2) {
    return 0;
  }
  std::vector<TriangleSurface> surfaces;
  for (const auto& piece : pieces) {
    surfaces.push_back(surface_of_faces(mesh, piece));
  }
  const std::vector<char> is_kept = near_first(surfaces, near_m);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (const Face face : is_kept[i] != 0 ? std::vector<Face>{} : pieces[i]) {
      CGAL::Euler::remove_face(mesh.halfedge(face), mesh);
    }
  }
  return static_cast<int>(std::ranges::count(is_kept, 0));
}

struct Corners {
  Corners(int i, int j, int k) : numbers{i, j, k} {}
  std::array<int, 3> numbers;
};

bool fill(Mesh& mesh, const std::vector<Vertex>& border) {
  std::vector<Point> polyline;
  for (const Vertex vertex : border) {
    polyline.push_back(mesh.point(vertex));
  }
  std::vector<Corners> patch;
  pmp::triangulate_hole_polyline(polyline, std::back_inserter(patch));
  bool is_filled = !patch.empty();
  for (const Corners& triangle : patch) {
    const auto corner = [&](std::size_t k) {
      return border[static_cast<std::size_t>(triangle.numbers.at(k))];
    };
    const bool is_added = mesh.add_face(corner(0), corner(1), corner(2)) != Mesh::null_face() ||
                          mesh.add_face(corner(0), corner(2), corner(1)) != Mesh::null_face();
    is_filled = is_filled && is_added;
  }
  return is_filled;
}

Holes fill_holes(Mesh& mesh, double longest_m) {
  std::vector<Halfedge> cycles;
  pmp::extract_boundary_cycles(mesh, std::back_inserter(cycles));
  std::vector<std::vector<Vertex>> borders;
  for (const Halfedge first : cycles) {
    auto& border = borders.emplace_back();
    for (const Halfedge h : mesh.halfedges_around_face(first)) {
      border.push_back(mesh.source(h));
    }
  }
  Holes holes;
  for (const auto& border : borders) {
    double length_m = 0.0;
    for (std::size_t i = 0; i < border.size(); ++i) {
      length_m +=
          (corner_m(mesh, border[(i + 1) % border.size()]) - corner_m(mesh, border[i])).norm();
    }
    if (length_m > holes.longest_m) {
      const Vec3 at_m = corner_m(mesh, border.front());
      holes.longest_m = length_m;
      holes.at_m = {at_m.x(), at_m.y(), at_m.z()};
    }
    const bool is_filled = length_m <= longest_m && border.size() > 2 && fill(mesh, border);
    ++(is_filled ? holes.filled : holes.left);
  }
  return holes;
}

MendedSurface mend(const TriangleSurface& surface, const MendRequest& request) {
  MendedSurface result;
  Mesh mesh = oriented_mesh(surface);
  replace_flat_triangles(mesh);
  if (request.is_largest_piece_only) {
    result.pieces_dropped = keep_largest_piece(mesh, request.near_m);
  }
  pmp::stitch_borders(mesh);
  result.holes = fill_holes(mesh, request.longest_hole_m);
  replace_flat_triangles(mesh);
  mesh.collect_garbage();
  result.surface = surface_of(mesh);
  if (core::volume_m3(result.surface) < 0.0) {
    result.surface.triangles.col(1).swap(result.surface.triangles.col(2));
  }
  return result;
}

const core::ChildJob mending{"mend a surface", [](const std::string& input) {
                               core::UnpackedBytes bytes{input};
                               const TriangleSurface surface = surface_in(bytes);
                               const auto request = bytes.get<std::vector<MendRequest>>().at(0);
                               const MendedSurface result = mend(surface, request);
                               core::PackedBytes output;
                               put(output, result.surface);
                               output.put(std::vector<Holes>{result.holes});
                               output.put(std::vector<int>{result.pieces_dropped});
                               return output.take();
                             }};
}  // namespace

MendedSurface mended(const TriangleSurface& surface, const MendRequest& request) {
  core::PackedBytes input;
  put(input, surface);
  input.put(std::vector<MendRequest>{request});
  const std::string output = core::in_bounded_child(
      mending, input.take(), "surface: it could not be mended", surface_job_limits);
  core::UnpackedBytes bytes{output};
  MendedSurface result;
  result.surface = surface_in(bytes);
  result.holes = bytes.get<std::vector<Holes>>().at(0);
  result.pieces_dropped = bytes.get<std::vector<int>>().at(0);
  return result;
}
}  // namespace tapstudy::protocols
