#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>
namespace tapstudy::core {
// End corners of a tetrahedron's edges, in the order of the mid-side nodes; the first three are the
// edges of a triangle.
inline constexpr std::array<std::array<int, 2>, 6> tet_edges{
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

inline constexpr std::array<std::array<int, 3>, 4> tet_faces{
    {{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}}};

// The bound on circumradius over shortest edge: what was asked for, and what the mesher was given,
// which is larger where the one asked for would have taken too many elements. 0: no mesher's.
struct RadiusEdgeRatio {
  double asked{0.0};
  double used{0.0};
  bool is_relaxed() const { return used > asked; }
};

// A body meshed with straight-sided tetrahedra of order 1 (T4: corner nodes) or 2 (T10: corner
// nodes, then mid-side nodes in the order of tet_edges); or of order 3, for error estimates only:
// T10, then an unknown an edge and a face (tet_edges, tet_faces) that are no displacements of
// nodes.
struct TetMesh {
  using Indices = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> nodes_m;  // one row per node
  Indices tets;  // 4 or 10 nodes per row (order 3: 20), positive volume
  Indices
      surface;  // 3 or 6 nodes per row: corners, outward counter-clockwise, then mid-side nodes
                // of the edges 01 12 20 (order 3: 10; then these edges' and the face's unknowns)
  RadiusEdgeRatio radius_edge_ratio{};
  // Whether each node of the mesh is one of these.
  std::vector<bool> marked(const std::vector<Eigen::Index>& nodes) const;
  int order() const { return tets.cols() == 20 ? 3 : tets.cols() == 10 ? 2 : 1; }
};

double triangle_area_m2(const TetMesh& mesh, Eigen::Index triangle);  // of the surface
double tet_volume_m3(const TetMesh& mesh, Eigen::Index tet);
double volume_m3(const TetMesh& mesh);

// The order 2 mesh of an order 1 mesh: every edge gets a mid-side node, numbered after the existing
// nodes.
TetMesh to_quadratic(const TetMesh& mesh);

// The order 3 mesh of an order 2 mesh: every edge, then every face gets an unknown, numbered after
// the existing nodes.
TetMesh to_hierarchic_cubic(const TetMesh& mesh);

// Writes PREFIX.node and PREFIX.ele in TetGen's own format, nodes numbered from 0, 17 digits.
// Throws InvalidInput if a file exists already or cannot be written.
void write_tetgen_files(const TetMesh& mesh, const std::string& prefix);
}  // namespace tapstudy::core
