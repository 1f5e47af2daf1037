#pragma once
#include <array>

#include "core/model/modal_model.hpp"
namespace tapstudy::core {
// A point on the touchable surface as its triangle's nodes and their shape functions (paper
// eq. 15, 16). On a face the shape functions of the tetrahedron's other nodes vanish, so those of
// the triangle suffice: three for order 1, six for order 2.
struct SurfacePoint {
  std::array<int, 6> nodes{};
  std::array<double, 6> weights{};
  std::size_t count{0};
};

// The place on one triangle of the model's surface, from its barycentric coordinates L, `at`: L_i,
// or L_i (2 L_i - 1) at corners and 4 L_i L_j in the middle of edges.
inline SurfacePoint surface_point(const ModalModel::Triangles& surface, int triangle,
                                  const std::array<double, 3>& at) noexcept {
  SurfacePoint point;
  point.count = surface.cols() == 6 ? 6 : 3;
  for (std::size_t i = 0; i < point.count; ++i) {
    point.nodes[i] = surface(triangle, static_cast<Eigen::Index>(i));
  }
  if (point.count == 3) {
    point.weights = {at[0], at[1], at[2]};
  } else {
    point.weights = {at[0] * (2.0 * at[0] - 1.0), at[1] * (2.0 * at[1] - 1.0),
                     at[2] * (2.0 * at[2] - 1.0), 4.0 * at[0] * at[1],
                     4.0 * at[1] * at[2],         4.0 * at[2] * at[0]};
  }
  return point;
}
}  // namespace tapstudy::core
