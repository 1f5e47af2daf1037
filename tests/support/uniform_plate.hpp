#pragma once
#include "core/tick/vibrating_plate.hpp"
namespace tapstudy::testing {
// A face of 0.6 × 0.6 m that moves up and down as a whole: in each mode by `shape` per unit of its
// modal coordinate, wherever it is touched.
inline core::VibratingPlate uniform_plate(const Eigen::ArrayXd& frequency_hz,
                                          const Eigen::ArrayXd& damping_ratio,
                                          const Eigen::ArrayXd& shape) {
  core::ModalModel model;
  model.frequency_hz = frequency_hz;
  model.damping_ratio = damping_ratio;
  model.touch_nodes_m.resize(4, 3);
  model.touch_nodes_m << -0.3, -0.3, 0.0, 0.3, -0.3, 0.0, 0.3, 0.3, 0.0, -0.3, 0.3, 0.0;
  model.touch_surface.resize(2, 3);
  model.touch_surface << 0, 1, 2, 0, 2, 3;
  model.shape.setZero(12, shape.size());
  for (Eigen::Index node = 0; node < 4; ++node) {
    model.shape.row(3 * node + 2) = shape.matrix().transpose();
  }
  return core::VibratingPlate{std::move(model)};
}
inline core::VibratingPlate uniform_plate(const Eigen::ArrayXd& frequency_hz, double damping_ratio,
                                          const Eigen::ArrayXd& shape) {
  return uniform_plate(frequency_hz, Eigen::ArrayXd::Constant(shape.size(), damping_ratio), shape);
}
}  // namespace tapstudy::testing
