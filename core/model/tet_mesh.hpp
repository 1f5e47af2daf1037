#pragma once
#include <Eigen/Core>
#include <string>
namespace tapstudy::core {
// A body cut into linear tetrahedra.
struct TetMesh {
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> nodes_m;  // one row a node
  Eigen::Matrix<int, Eigen::Dynamic, 4, Eigen::RowMajor> tets;     // node indices, positive volume
  Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor> surface;  // outward counter-clockwise
};

double tet_volume_m3(const TetMesh& mesh, Eigen::Index tet);
double volume_m3(const TetMesh& mesh);

// Writes PREFIX.node and PREFIX.ele in TetGen's own format, nodes numbered from 0, 17 digits.
// Throws InvalidInput if a file exists already or cannot be written.
void write_tetgen_files(const TetMesh& mesh, const std::string& prefix);
}  // namespace tapstudy::core
