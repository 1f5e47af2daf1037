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

// The rows with the mid-side nodes of their first `count` edges appended to the corners.
TetMesh::Indices with_edge_midpoints(const TetMesh::Indices& corners, std::size_t count,
                                     const std::vector<Edge>& edges, int first_middle) {
  TetMesh::Indices rows{corners.rows(), corners.cols() + static_cast<Eigen::Index>(count)};
  rows.leftCols(corners.cols()) = corners;
  for (Eigen::Index row = 0; row < corners.rows(); ++row) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto found = std::ranges::lower_bound(edges, edge_of(corners, row, tet_edges.at(i)));
      rows(row, corners.cols() + static_cast<Eigen::Index>(i)) =
          first_middle + static_cast<int>(found - edges.begin());
    }
  }
  return rows;
}
}  // namespace

TetMesh to_quadratic(const TetMesh& mesh) {
  const std::vector<Edge> edges = edges_of(mesh);
  const Eigen::Index corners = mesh.nodes_m.rows();
  TetMesh result;
  result.nodes_m.resize(corners + static_cast<Eigen::Index>(edges.size()), 3);
  result.nodes_m.topRows(corners) = mesh.nodes_m;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    result.nodes_m.row(corners + static_cast<Eigen::Index>(i)) =
        0.5 * (mesh.nodes_m.row(edges[i][0]) + mesh.nodes_m.row(edges[i][1]));
  }
  result.tets = with_edge_midpoints(mesh.tets, 6, edges, static_cast<int>(corners));
  result.surface = with_edge_midpoints(mesh.surface, 3, edges, static_cast<int>(corners));
  return result;
}
}  // namespace tapstudy::core
