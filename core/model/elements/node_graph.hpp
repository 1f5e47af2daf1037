#pragma once
#include <vector>

#include "core/model/mesh/tet_mesh.hpp"
namespace tapstudy::core {
// Which nodes share an element: for each node, itself and its higher-numbered neighbours,
// ascending. The sparsity pattern of the lower triangles of K and M.
struct NodeGraph {
  std::vector<int> first;       // node j's list is neighbours[first[j]] … [first[j + 1])
  std::vector<int> neighbours;  // starts with j itself where j is in an element
  int place_of(int node, int neighbour) const;
};
NodeGraph node_graph(const TetMesh& mesh);
}  // namespace tapstudy::core
