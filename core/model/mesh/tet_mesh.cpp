#include "core/model/mesh/tet_mesh.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <vector>

#include "core/files/output_files.hpp"
#include "core/text/print.hpp"
namespace tapstudy::core {
namespace {
// TetGen's node order of a T10: corners, then the mid-side nodes of 23 03 01 12 13 02.
constexpr std::array<Eigen::Index, 10> tetgen_order{0, 1, 2, 3, 9, 7, 4, 5, 8, 6};

void write_nodes(std::ostream& out, const TetMesh& mesh) {
  core::print(out, "{} 3 0 0\n", mesh.nodes_m.rows());
  for (Eigen::Index i = 0; i < mesh.nodes_m.rows(); ++i) {
    core::print(out, "{} {:.17g} {:.17g} {:.17g}\n", i, mesh.nodes_m(i, 0), mesh.nodes_m(i, 1),
                mesh.nodes_m(i, 2));
  }
}

void write_elements(std::ostream& out, const TetMesh& mesh) {
  core::print(out, "{} {} 0\n", mesh.tets.rows(), mesh.tets.cols());
  for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
    core::print(out, "{}", tet);
    for (Eigen::Index i = 0; i < mesh.tets.cols(); ++i) {
      core::print(out, " {}", mesh.tets(tet, tetgen_order.at(static_cast<std::size_t>(i))));
    }
    core::print(out, "\n");
  }
}
}  // namespace

std::vector<bool> TetMesh::marked(const std::vector<Eigen::Index>& nodes) const {
  std::vector<bool> is_marked(static_cast<std::size_t>(nodes_m.rows()), false);
  for (const Eigen::Index node : nodes) {
    is_marked[static_cast<std::size_t>(node)] = true;
  }
  return is_marked;
}

double triangle_area_m2(const TetMesh& mesh, Eigen::Index triangle) {
  const auto corner = [&](Eigen::Index i) -> Eigen::Vector3d {
    return mesh.nodes_m.row(mesh.surface(triangle, i));
  };
  return 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
}

double tet_volume_m3(const TetMesh& mesh, Eigen::Index tet) {
  const auto corner = [&](Eigen::Index i) -> Eigen::Vector3d {
    return mesh.nodes_m.row(mesh.tets(tet, i));
  };
  const Eigen::Vector3d origin = corner(0);
  return (corner(1) - origin).cross(corner(2) - origin).dot(corner(3) - origin) / 6.0;
}

double volume_m3(const TetMesh& mesh) {
  double sum = 0.0;
  for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
    sum += tet_volume_m3(mesh, tet);
  }
  return sum;
}

void write_tetgen_files(const TetMesh& mesh, const std::string& prefix) {
  check_is_new(prefix + ".node");
  check_is_new(prefix + ".ele");
  write_new_file(prefix + ".node", [&](std::ostream& out) { write_nodes(out, mesh); });
  write_new_file(prefix + ".ele", [&](std::ostream& out) { write_elements(out, mesh); });
}

namespace {
using Edge = std::array<int, 2>;  // ascending

Edge edge_of(const TetMesh::Indices& corners, Eigen::Index row, const Edge& ends) {
  const int a = corners(row, ends[0]);
  const int b = corners(row, ends[1]);
  return {std::min(a, b), std::max(a, b)};
}

std::vector<Edge> edges_of(const TetMesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(tet_edges.size() * static_cast<std::size_t>(mesh.tets.rows()));
  for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
    for (const Edge& ends : tet_edges) {
      edges.push_back(edge_of(mesh.tets, tet, ends));
    }
  }
  std::ranges::sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

using Face = std::array<int, 3>;  // ascending

Face face_of(const TetMesh::Indices& corners, Eigen::Index row, const Face& ends) {
  Face face{corners(row, ends[0]), corners(row, ends[1]), corners(row, ends[2])};
  std::ranges::sort(face);
  return face;
}

std::vector<Face> faces_of(const TetMesh& mesh) {
  std::vector<Face> faces;
  faces.reserve(tet_faces.size() * static_cast<std::size_t>(mesh.tets.rows()));
  for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
    for (const Face& ends : tet_faces) {
      faces.push_back(face_of(mesh.tets, tet, ends));
    }
  }
  std::ranges::sort(faces);
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

// The rows with a number for each of their first `count` edges or faces appended, whose corners
// `part_of` gives; `parts` are all of the mesh, sorted.
template <class Part, class PartOf>
TetMesh::Indices with_numbers(const TetMesh::Indices& nodes, std::size_t count,
                              const std::vector<Part>& parts, Eigen::Index first,
                              const PartOf& part_of) {
  TetMesh::Indices rows{nodes.rows(), nodes.cols() + static_cast<Eigen::Index>(count)};
  rows.leftCols(nodes.cols()) = nodes;
  for (Eigen::Index row = 0; row < nodes.rows(); ++row) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto found = std::ranges::lower_bound(parts, part_of(row, i));
      rows(row, nodes.cols() + static_cast<Eigen::Index>(i)) =
          static_cast<int>(first + (found - parts.begin()));
    }
  }
  return rows;
}

TetMesh::Indices with_edges(const TetMesh::Indices& nodes, std::size_t count,
                            const std::vector<Edge>& edges, Eigen::Index first) {
  return with_numbers(nodes, count, edges, first, [&](Eigen::Index row, std::size_t i) {
    return edge_of(nodes, row, tet_edges.at(i));
  });
}

// The corners of the faces are their rows' first columns.
TetMesh::Indices with_faces(const TetMesh::Indices& nodes, std::size_t count,
                            const std::vector<Face>& faces, Eigen::Index first) {
  return with_numbers(nodes, count, faces, first, [&](Eigen::Index row, std::size_t i) {
    return face_of(nodes, row, tet_faces.at(i));
  });
}

// The nodes, and after them the middle of each of these edges or faces.
template <class Corners>
void append_middles(const std::vector<Corners>& all, TetMesh& mesh) {
  const Eigen::Index before = mesh.nodes_m.rows();
  mesh.nodes_m.conservativeResize(before + static_cast<Eigen::Index>(all.size()), 3);
  for (std::size_t i = 0; i < all.size(); ++i) {
    mesh.nodes_m.row(before + static_cast<Eigen::Index>(i)) =
        mesh.nodes_m(all[i], Eigen::all).colwise().mean();
  }
}
}  // namespace

TetMesh to_quadratic(const TetMesh& mesh) {
  const std::vector<Edge> edges = edges_of(mesh);
  const Eigen::Index corners = mesh.nodes_m.rows();
  TetMesh result;
  result.radius_edge_ratio = mesh.radius_edge_ratio;
  result.nodes_m.resize(corners + static_cast<Eigen::Index>(edges.size()), 3);
  result.nodes_m.topRows(corners) = mesh.nodes_m;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    result.nodes_m.row(corners + static_cast<Eigen::Index>(i)) =
        0.5 * (mesh.nodes_m.row(edges[i][0]) + mesh.nodes_m.row(edges[i][1]));
  }
  result.tets = with_edges(mesh.tets, 6, edges, corners);
  result.surface = with_edges(mesh.surface, 3, edges, corners);
  return result;
}

TetMesh to_hierarchic_cubic(const TetMesh& mesh) {
  const std::vector<Edge> edges = edges_of(mesh);
  const std::vector<Face> faces = faces_of(mesh);
  TetMesh result{mesh.nodes_m, {}, {}, mesh.radius_edge_ratio};
  append_middles(edges, result);
  append_middles(faces, result);
  const Eigen::Index first_edge = mesh.nodes_m.rows();
  const auto first_face = first_edge + static_cast<Eigen::Index>(edges.size());
  result.tets = with_faces(with_edges(mesh.tets, 6, edges, first_edge), 4, faces, first_face);
  result.surface = with_faces(with_edges(mesh.surface, 3, edges, first_edge), 1, faces, first_face);
  return result;
}
}  // namespace tapstudy::core
