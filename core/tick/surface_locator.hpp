#pragma once
#include <array>
#include <vector>

#include "core/model/modal_model.hpp"
namespace tapstudy::core {
// A point of the touchable surface as its surrounding nodes and their shape functions (paper
// eq. 15, 16). On a face the tetrahedron's fourth shape function is zero, so three nodes suffice.
struct SurfacePoint {
  std::array<int, 3> nodes{};
  std::array<double, 3> weights{};
};

// Finds the triangle under a point of a flat face in constant time: a grid over the face, each cell
// listing the few triangles that overlap it. Built once, never changed.
class SurfaceLocator {
 public:
  explicit SurfaceLocator(const ModalModel& model);
  // Points off the face, or between cells by rounding, go to the nearest triangle listed there.
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
  std::vector<std::array<int, 3>> nodes_;
  std::vector<int> first_in_cell_;  // into triangles_, one more than cells
  std::vector<int> triangles_;
};
}  // namespace tapstudy::core
