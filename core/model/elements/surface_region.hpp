#pragma once
#include <Eigen/Core>
#include <vector>

#include "core/model/mesh/tet_mesh.hpp"
namespace tapstudy::core {
// The surface triangles all of whose nodes are among these.
std::vector<Eigen::Index> triangles_within(const TetMesh& mesh,
                                           const std::vector<Eigen::Index>& nodes);

struct NodeWeight {
  Eigen::Index node{};
  double weight{};
};
// The weights, of sum 1, whose sum over nodal displacements is the mean displacement of the
// triangles within the nodes, by the elements' shape functions; of the nodes themselves where there
// is no such triangle.
std::vector<NodeWeight> mean_weights(const TetMesh& mesh, const std::vector<Eigen::Index>& nodes);
}  // namespace tapstudy::core
