#include "core/model/elements/node_graph.hpp"

#include <algorithm>
namespace tapstudy::core {
namespace {
struct ElementsOfNodes {
  std::vector<int> first;
  std::vector<int> elements;
};

ElementsOfNodes elements_of_nodes(const TetMesh& mesh) {
  ElementsOfNodes result;
  result.first.assign(static_cast<std::size_t>(mesh.nodes_m.rows()) + 1, 0);
  for (const int node : mesh.tets.reshaped()) {
    ++result.first[static_cast<std::size_t>(node) + 1];
  }
  for (std::size_t i = 1; i < result.first.size(); ++i) {
    result.first[i] += result.first[i - 1];
  }
  std::vector<int> next{result.first.begin(), result.first.end() - 1};
  result.elements.resize(static_cast<std::size_t>(mesh.tets.size()));
  for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
    for (const int node : mesh.tets.row(tet)) {
      const int place = next[static_cast<std::size_t>(node)]++;
      result.elements[static_cast<std::size_t>(place)] = static_cast<int>(tet);
    }
  }
  return result;
}
}  // namespace

NodeGraph node_graph(const TetMesh& mesh) {
  const ElementsOfNodes around = elements_of_nodes(mesh);
  NodeGraph graph;
  graph.first.push_back(0);
  std::vector<int> seen_from(static_cast<std::size_t>(mesh.nodes_m.rows()), -1);
  for (int node = 0; node < mesh.nodes_m.rows(); ++node) {
    const auto start = static_cast<std::ptrdiff_t>(graph.neighbours.size());
    const auto own = static_cast<std::size_t>(node);
    for (int k = around.first[own]; k < around.first[own + 1]; ++k) {
      for (const int other : mesh.tets.row(around.elements[static_cast<std::size_t>(k)])) {
        int& seen = seen_from[static_cast<std::size_t>(other)];
        if (other >= node && seen != node) {
          seen = node;
          graph.neighbours.push_back(other);
        }
      }
    }
    std::sort(graph.neighbours.begin() + start, graph.neighbours.end());
    graph.first.push_back(static_cast<int>(graph.neighbours.size()));
  }
  return graph;
}

int NodeGraph::place_of(int node, int neighbour) const {
  const auto own = static_cast<std::size_t>(node);
  const auto begin = neighbours.begin() + first[own];
  const auto end = neighbours.begin() + first[own + 1];
  return static_cast<int>(std::lower_bound(begin, end, neighbour) - neighbours.begin());
}
}  // namespace tapstudy::core
