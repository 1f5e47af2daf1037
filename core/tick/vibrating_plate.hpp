#pragma once
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/geometry/triangle_tree.hpp"
#include "core/model/modal_model.hpp"
#include "core/tick/contact.hpp"
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

// Finds the triangle under a point of a flat face in constant time: a grid over the face, each cell
// listing the few triangles that overlap it. Built once, never changed.
class SurfaceLocator {
 public:
  explicit SurfaceLocator(const ModalModel& model);
  // Points off the face, or missed by rounding, are assigned to the cell's nearest triangle.
  SurfacePoint locate(double x_m, double y_m) const noexcept;

 private:
  struct Corners {
    std::array<double, 3> x;
    std::array<double, 3> y;
  };
  std::size_t cell_of(double x_m, double y_m) const noexcept;
  static std::array<double, 3> barycentric(const Corners& corners, double x_m, double y_m) noexcept;

  double low_x_m_{0.0};
  double low_y_m_{0.0};
  double cells_per_m_x_{0.0};
  double cells_per_m_y_{0.0};
  std::size_t cells_x_{1};
  std::size_t cells_y_{1};
  std::vector<Corners> corners_;
  ModalModel::Triangles surface_;
  std::vector<int> first_in_cell_;  // into triangles_; cells + 1 entries
  std::vector<int> triangles_;
};

// The model of a plate with its point-location structure. Built once, shared by renderers.
struct VibratingPlate {
  // A plate, of which the upper face is touched.
  explicit VibratingPlate(ModalModel modal);
  // A body touched anywhere on its model's own surface triangles.
  static VibratingPlate touched_all_over(ModalModel modal);

  // The nodes and shape functions at the god-object (paper eq. 15, 16).
  SurfacePoint place_of(const Contact& contact) const noexcept;

  ModalModel model;
  std::optional<SurfaceLocator> locator;          // of a plate
  std::shared_ptr<const TriangleTree> triangles;  // of any other body

 private:
  struct AllOver {};
  VibratingPlate(ModalModel modal, AllOver all_over);
};
}  // namespace tapstudy::core
