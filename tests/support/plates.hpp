#pragma once
#include "core/model/plate_model.hpp"
#include "core/tick/vibrating_plate.hpp"
namespace tapstudy::testing {
// The paper's Table 1 and Figure 2.
inline core::Material mdf() {
  return {2.5e9, 610.0, 0.25, core::RayleighDamping{120.0, 7.05e-5}};
}
inline core::Material acrylic() {
  return {3.2e9, 1180.0, 0.35, core::RayleighDamping{120.0, 8.5e-5}};
}
inline core::Fixation corner_vertex(double sign_x, double sign_y) {
  core::Fixation fixation;
  fixation.at_m = {0.3 * sign_x, 0.3 * sign_y, 0.0};
  return fixation;
}
inline core::PlateSpec paper_plate(int corners, const core::Material& material) {
  const std::vector<core::Fixation> all{corner_vertex(-1, -1), corner_vertex(1, -1),
                                        corner_vertex(1, 1), corner_vertex(-1, 1)};
  return {{core::Box{{0.6, 0.6, 0.05}}, {}, {all.begin(), all.begin() + corners}}, material, 300.0};
}

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
