#include "core/model/plate_model.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.hpp"
#include "core/model/modes/damping.hpp"
namespace tapstudy::core {
namespace {
constexpr double rounding = 1e-12;

// Otherwise modes between the body's band limit and the requested one would be missing silently.
void check_band(const BodyModes& body, const Material& material, double band_limit_hz) {
  const double solved_hz = body.band_limit_rad_per_m / kappa_rad_per_m(1.0, material);
  if (band_limit_hz > solved_hz * (1.0 + rounding)) {
    throw ModelError{
        fmt::format("modes: a band of {} Hz is requested, but the body was only solved up to {} Hz",
                    band_limit_hz, solved_hz)};
  }
}
}  // namespace

double kappa_rad_per_m(double frequency_hz, const Material& material) {
  const double bar_speed_m_s = std::sqrt(material.youngs_modulus_pa / material.density_kg_per_m3);
  return 2.0 * std::numbers::pi * frequency_hz / bar_speed_m_s;
}

BodySpec body_of(const PlateSpec& plate) {
  Plate of_unit_material = plate;
  for (Fixation& fixation : of_unit_material.fixations) {
    if (fixation.springs_n_per_m) {
      *fixation.springs_n_per_m /= plate.material.youngs_modulus_pa;
    }
  }
  return {std::move(of_unit_material), plate.material.poissons_ratio,
          kappa_rad_per_m(plate.band_limit_hz, plate.material)};
}

ModalModel model_of(const BodyModes& body, const Material& material, double band_limit_hz) {
  check_material(material);
  check_band(body, material, band_limit_hz);
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
