#pragma once
#include <Eigen/Core>
#include <optional>

#include "core/model/elements/material.hpp"
namespace tapstudy::core {
// Paper eq. 13: the Rayleigh coefficients that give two modes their damping ratios.
// 0 < first < last [rad/s]. Throws ModelError if they are not, or if a coefficient comes out
// negative, which would feed energy into some mode.
RayleighDamping rayleigh_from_two_ratios(const TwoRatioDamping& ratios, double first_rad_s,
                                         double last_rad_s);

// The coefficients with the least squared error of (alpha / omega + beta omega) / 2 (eq. 12) at the
// given points. Throws ModelError for fewer than two frequencies or a negative coefficient.
RayleighDamping rayleigh_by_least_squares(const FittedDamping& measured);

// Paper eq. 12: zeta = (alpha / omega + beta omega) / 2 for every mode. omega ascending, > 0.
Eigen::ArrayXd damping_ratios(const RayleighDamping& damping, const Eigen::ArrayXd& omega_rad_s);

struct DampedModes {
  std::optional<RayleighDamping> rayleigh;
  Eigen::ArrayXd ratios;
};
// The part of the modes' damping ratios that is due to one of several bodies: its ratio at the
// mode's frequency by its share of the strain energy (modal strain energy method: Ungar & Kerwin
// 1962; Johnson & Kienholz 1982); where coefficients are stated, alpha's part by its share of the
// kinetic energy (eq. 3). Damping terms that couple modes are left out, as is usual for light
// damping. Throws ModelError as damp, and for a list of modal ratios: the modes are not those of
// one body.
Eigen::ArrayXd damping_ratios_due_to(const Damping& damping, const Eigen::ArrayXd& omega_rad_s,
                                     const Eigen::ArrayXd& kinetic_share,
                                     const Eigen::ArrayXd& strain_share);

// Applies a material's damping to these modes; rayleigh is unset where no coefficients are behind
// it. Throws ModelError if it does not fit them.
DampedModes damp(const Damping& damping, const Eigen::ArrayXd& omega_rad_s);
}  // namespace tapstudy::core
