#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <utility>
namespace tapstudy::core {
// The elasticity of a body whose properties mirror at three planes: wood, plywood, laminates, board
// through its thickness. 1, 2 and 3 are the material's axes. nu_ij is the contraction along j over
// the extension along i under a load along i, so that nu_ij / E_i = nu_ji / E_j.
struct Orthotropy {
  // Of axes, from 0, in the order of Poisson's ratios and shear moduli.
  static constexpr std::array<std::pair<Eigen::Index, Eigen::Index>, 3> pairs{
      {{0, 1}, {0, 2}, {1, 2}}};

  std::array<double, 3> moduli{1.0, 1.0, 1.0};  // relative to E_1, so that the first is 1
  std::array<double, 3> poissons_ratios{};      // nu_12, nu_13, nu_23
  std::array<double, 3> shear_moduli{};         // G_12, G_13, G_23, relative to E_1
  // From the body's axes to the material's: about the direction of this vector by its length.
  std::array<double, 3> rotation_rad{};
  bool operator==(const Orthotropy&) const = default;
};

// About the direction of a vector by its length.
Eigen::Matrix3d rotation(const std::array<double, 3>& rotation_rad);

// Which property no solid can have, and the inequality that fails, in words: a strained solid must
// hold energy, so that its compliance is positive definite (Lempriere 1968). Empty: none.
struct ElasticityFault {
  std::string property;  // as a key of protocols names it
  std::string words;
};
std::optional<ElasticityFault> fault_of(const Orthotropy& elasticity);

// Equal text for equal elasticities; empty for an isotropic one.
std::string content_key(const std::optional<Orthotropy>& elasticity);
}  // namespace tapstudy::core
