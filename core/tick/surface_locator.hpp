#pragma once
#include <array>
#include <vector>

#include "core/model/modal_model.hpp"
#include "core/tick/surface_point.hpp"
namespace tapstudy::core {
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
}  // namespace tapstudy::core
