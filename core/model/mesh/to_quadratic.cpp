#include <algorithm>
#include <array>
#include <vector>

#include "core/model/mesh/tet_mesh.hpp"
namespace tapstudy::core {
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
