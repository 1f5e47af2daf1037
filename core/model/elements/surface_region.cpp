#include "core/model/elements/surface_region.hpp"

#include <algorithm>
#include <map>
namespace tapstudy::core {
std::vector<Eigen::Index> triangles_within(const TetMesh& mesh,
                                           const std::vector<Eigen::Index>& nodes) {
  const std::vector<bool> is_held = mesh.marked(nodes);
  std::vector<Eigen::Index> triangles;
  for (Eigen::Index i = 0; i < mesh.surface.rows(); ++i) {
    if (std::ranges::all_of(mesh.surface.row(i),
                            [&](int node) { return is_held[static_cast<std::size_t>(node)]; })) {
      triangles.push_back(i);
    }
  }
  return triangles;
}

std::vector<NodeWeight> mean_weights(const TetMesh& mesh, const std::vector<Eigen::Index>& nodes) {
  std::map<Eigen::Index, double> weight_of;
  double whole_m2 = 0.0;
  // The integral of a quadratic shape function over its triangle is 0 for a corner and a third of
  // the area for a mid-side node; of a linear one a third of the area.
  const Eigen::Index first = mesh.order() == 2 ? 3 : 0;
  for (const Eigen::Index triangle : triangles_within(mesh, nodes)) {
    const double area_m2 = triangle_area_m2(mesh, triangle);
    whole_m2 += area_m2;
    for (Eigen::Index i = first; i < first + 3; ++i) {
      weight_of[mesh.surface(triangle, i)] += area_m2 / 3.0;
    }
  }
  std::vector<NodeWeight> weights;
  for (const auto& [node, area_m2] : weight_of) {
    weights.push_back({node, area_m2 / whole_m2});
  }
  if (weights.empty()) {
    for (const Eigen::Index node : nodes) {
      weights.push_back({node, 1.0 / static_cast<double>(nodes.size())});
    }
  }
  return weights;
}
}  // namespace tapstudy::core
