#include "core/model/touchable_part.hpp"

#include <cmath>
namespace tapstudy::core {
namespace {
bool is_touchable(const TetMesh& mesh, Eigen::Index triangle, const Shape& shape) {
  if (!std::holds_alternative<Box>(shape)) {
    return true;
  }
  const Bounds body = bounds(shape);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double z_m = mesh.nodes_m(mesh.surface(triangle, i), 2);
    if (std::abs(z_m - body.high_m.z()) > body.snap_m()) {
      return false;
    }
  }
  return true;
}
}  // namespace

void keep_touchable_part(const Shape& shape, SolvedBody& solved) {
  const TetMesh& mesh = solved.mesh;
  std::vector<int> renumbered(static_cast<std::size_t>(mesh.nodes_m.rows()), -1);
  std::vector<int> kept_nodes;
  std::vector<Eigen::Index> kept_triangles;
  for (Eigen::Index triangle = 0; triangle < mesh.surface.rows(); ++triangle) {
    if (!is_touchable(mesh, triangle, shape)) {
      continue;
    }
    kept_triangles.push_back(triangle);
    for (const int node : mesh.surface.row(triangle)) {
      int& number = renumbered[static_cast<std::size_t>(node)];
      if (number < 0) {
        number = static_cast<int>(kept_nodes.size());
        kept_nodes.push_back(node);
      }
    }
  }
  BodyModes& modes = solved.modes;
  modes.touch_surface = mesh.surface(kept_triangles, Eigen::all).unaryExpr([&](int node) {
    return renumbered[static_cast<std::size_t>(node)];
  });
  modes.touch_nodes_m = mesh.nodes_m(kept_nodes, Eigen::all);
  modes.shape.resize(3 * modes.touch_nodes_m.rows(), solved.displacement.cols());
  for (std::size_t i = 0; i < kept_nodes.size(); ++i) {
    modes.shape.middleRows(static_cast<Eigen::Index>(3 * i), 3) =
        solved.displacement.middleRows(Eigen::Index{3} * kept_nodes[i], 3);
  }
}
}  // namespace tapstudy::core
