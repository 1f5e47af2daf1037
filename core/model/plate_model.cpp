#include "core/model/plate_model.hpp"

#include <cmath>
#include <numbers>

#include "core/model/modes/damping.hpp"
namespace tapstudy::core {
double kappa_rad_per_m(double frequency_hz, const Material& material) {
  const double bar_speed_m_s = std::sqrt(material.youngs_modulus_pa / material.density_kg_per_m3);
  return 2.0 * std::numbers::pi * frequency_hz / bar_speed_m_s;
}

BodySpec body_of(const PlateSpec& plate) {
  return {plate.shape, plate.mesh, plate.fixations, plate.material.poissons_ratio,
          kappa_rad_per_m(plate.band_limit_hz, plate.material)};
}

ModalModel model_of(const BodyModes& body, const Material& material, double band_limit_hz) {
  check_material(material);
  const Eigen::ArrayXd frequency_hz = body.kappa_rad_per_m / kappa_rad_per_m(1.0, material);
  const Eigen::Index modes = (frequency_hz < band_limit_hz).count();
  ModalModel model;
  model.frequency_hz = frequency_hz.head(modes);
  const DampedModes damped = damp(material.damping, 2.0 * std::numbers::pi * model.frequency_hz);
  model.damping = damped.rayleigh;
  model.damping_ratio = damped.ratios;
  model.touch_nodes_m = body.touch_nodes_m;
  model.touch_surface = body.touch_surface;
  model.shape = body.shape.leftCols(modes) / std::sqrt(material.density_kg_per_m3);
  return model;
}

PlateModel build_plate_model(const PlateSpec& plate, const ProgressHook& progress) {
  check_material(plate.material);
  PlateModel built;
  built.body = solve_body(body_of(plate), progress);
  built.modal = model_of(built.body.modes, plate.material, plate.band_limit_hz);
  return built;
}
}  // namespace tapstudy::core
