#pragma once
#include <Eigen/Core>

#include "core/model/material.hpp"
namespace tapstudy::core {
// Paper eq. 13: the Rayleigh coefficients that give two modes their damping ratios.
// 0 < first < last [rad/s]. Throws ModelError if they are not, or if a coefficient comes out
// negative, which would feed energy into some mode.
RayleighDamping rayleigh_from_two_ratios(const TwoRatioDamping& ratios, double first_rad_s,
                                         double last_rad_s);

// Paper eq. 12: zeta = (alpha / omega + beta omega) / 2 for every mode. omega ascending, > 0.
Eigen::ArrayXd damping_ratios(const RayleighDamping& damping, const Eigen::ArrayXd& omega_rad_s);

// The coefficients that a material's damping means for these modes.
RayleighDamping rayleigh_of(const Damping& damping, const Eigen::ArrayXd& omega_rad_s);
}  // namespace tapstudy::core
