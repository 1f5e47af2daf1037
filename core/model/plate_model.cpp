#include "core/model/plate_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "core/error.hpp"
#include "core/model/joints/joints.hpp"
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
// Damping ratios: each body contributes its part, and each spring half of its loss factor (Ungar &
// Kerwin 1962).
DampedModes damped_with_joints(const BodyModes& body, const Material& material,
                               const Joints& joints, const Eigen::ArrayXd& omega_rad_s) {
  const Eigen::Index modes = omega_rad_s.size();
  const auto part = [&](const Material& one, Eigen::Index row) -> Eigen::ArrayXd {
    return damping_ratios_due_to(one.damping, omega_rad_s,
                                 body.kinetic_share.row(row).head(modes).transpose(),
                                 body.strain_share.row(row).head(modes).transpose());
  };
  DampedModes damped{std::nullopt, part(material, 0)};
  for (std::size_t i = 0; i < joints.bodies.size(); ++i) {
    damped.ratios += part(joints.bodies[i].material, static_cast<Eigen::Index>(i) + 1);
  }
  const auto first_spring = static_cast<Eigen::Index>(joints.bodies.size()) + 1;
  for (std::size_t i = 0; i < joints.springs.size(); ++i) {
    const Eigen::Index row = first_spring + static_cast<Eigen::Index>(i);
    damped.ratios += 0.5 * joints.springs[i].loss_factor *
                     body.strain_share.row(row).head(modes).transpose().array();
  }
  return damped;
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
  std::shared_ptr<const Joints> joints;
  if (plate.joints) {
    joints = std::make_shared<const Joints>(relative_to(
        *plate.joints, plate.material.youngs_modulus_pa, plate.material.density_kg_per_m3));
  }
  return {std::move(of_unit_material), plate.material.poissons_ratio,
          kappa_rad_per_m(plate.band_limit_hz, plate.material), std::move(joints),
          plate.material.orthotropy};
}

ModalModel model_of(const BodyModes& body, const PlateSpec& plate) {
  return model_of(body, plate.material, plate.band_limit_hz, plate.joints.get());
}

ModalModel model_of(const BodyModes& body, const Material& material, double band_limit_hz,
                    const Joints* joints) {
  check_material(material);
  check_band(body, material, band_limit_hz);
  const Eigen::ArrayXd frequency_hz = body.kappa_rad_per_m / kappa_rad_per_m(1.0, material);
  const Eigen::Index modes = (frequency_hz < band_limit_hz).count();
  ModalModel model;
  model.frequency_hz = frequency_hz.head(modes);
  const Eigen::ArrayXd omega_rad_s = 2.0 * std::numbers::pi * model.frequency_hz;
  const DampedModes damped = joints == nullptr
                                 ? damp(material.damping, omega_rad_s)
                                 : damped_with_joints(body, material, *joints, omega_rad_s);
  model.damping = damped.rayleigh;
  model.damping_ratio = damped.ratios;
  model.touch_nodes_m = body.touch_nodes_m;
  model.touch_surface = body.touch_surface;
  model.shape = body.shape.leftCols(modes) / std::sqrt(material.density_kg_per_m3);
  return model;
}

FrequencyErrors frequency_errors(const BodyModes& body, const Material& material,
                                 double band_limit_hz) {
  constexpr double little = 1e-4;
  const double unit = kappa_rad_per_m(1.0, material);
  const auto below = [&](const Eigen::ArrayXd& kappa) {
    return (kappa / unit < band_limit_hz).count();
  };
  const Eigen::Index modes = below(body.kappa_rad_per_m);
  const Eigen::ArrayXd& larger = body.estimate.kappa_rad_per_m;
  FrequencyErrors errors;
  errors.not_estimated = body.estimate.not_estimated;
  errors.held_in_part = body.estimate.held_in_part;
  errors.modes_at_least = static_cast<int>(modes);
  if (errors.not_estimated.empty() && larger.size() >= modes) {
    const Eigen::ArrayXd above = body.kappa_rad_per_m.head(modes) / larger.head(modes) - 1.0;
    errors.relative = above.abs();
    errors.is_either_way = (above < -little).any();
    errors.modes_at_least = static_cast<int>(std::max(modes, below(larger)));
  }
  return errors;
}

std::string describe_error(double relative) {
  constexpr double known_up_to = 0.5;
  return relative > known_up_to ? fmt::format("over {:.0f} %", 100.0 * known_up_to)
                                : fmt::format("{:.2g} %", 100.0 * relative);
}

PlateModel build_plate_model(const PlateSpec& plate, const ProgressHook& progress,
                             ErrorEstimation estimation) {
  check_material(plate.material);
  PlateModel built;
  built.body = solve_body(body_of(plate), progress, estimation);
  built.modal = model_of(built.body.modes, plate);
  return built;
}
}  // namespace tapstudy::core
