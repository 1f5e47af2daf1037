#include "core/model/elements/orthotropy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
namespace tapstudy::core {
namespace {
// Far above rounding, and below what the least compressible rubbers have.
constexpr double least_determinant = 1e-9;

bool are_positive(const std::array<double, 3>& values) {
  return std::ranges::all_of(values,
                             [](double value) { return std::isfinite(value) && value > 0.0; });
}

// nu_ij nu_ji = nu_ij² E_j / E_i of a pair.
double squared_coupling(const Orthotropy& elasticity, std::size_t number) {
  const auto& [i, j] = Orthotropy::pairs.at(number);
  const double ratio = elasticity.poissons_ratios.at(number);
  return ratio * ratio * elasticity.moduli.at(static_cast<std::size_t>(j)) /
         elasticity.moduli.at(static_cast<std::size_t>(i));
}

std::optional<ElasticityFault> fault_of_pair(const Orthotropy& elasticity, std::size_t number) {
  if (squared_coupling(elasticity, number) < 1.0) {
    return std::nullopt;
  }
  const auto& [i, j] = Orthotropy::pairs.at(number);
  const double limit = std::sqrt(elasticity.moduli.at(static_cast<std::size_t>(i)) /
                                 elasticity.moduli.at(static_cast<std::size_t>(j)));
  return ElasticityFault{
      "poissons_ratios",
      fmt::format("|nu_{0}{1}| = {2:.4g} is not less than sqrt(E_{0} / E_{1}) = {3:.4g}, so that "
                  "the solid would give energy when it is strained",
                  i + 1, j + 1, std::abs(elasticity.poissons_ratios.at(number)), limit)};
}

// 1 - nu_12 nu_21 - nu_13 nu_31 - nu_23 nu_32 - 2 nu_21 nu_32 nu_13.
double determinant(const Orthotropy& elasticity) {
  double value = 1.0;
  for (std::size_t pair = 0; pair < Orthotropy::pairs.size(); ++pair) {
    value -= squared_coupling(elasticity, pair);
  }
  const auto& [nu_12, nu_13, nu_23] = elasticity.poissons_ratios;
  const double nu_21 = nu_12 * elasticity.moduli[1] / elasticity.moduli[0];
  const double nu_32 = nu_23 * elasticity.moduli[2] / elasticity.moduli[1];
  return value - 2.0 * nu_21 * nu_32 * nu_13;
}
}  // namespace

Eigen::Matrix3d rotation(const std::array<double, 3>& rotation_rad) {
  const Eigen::Vector3d turn{rotation_rad.data()};
  return turn.norm() > 0.0 ? Eigen::AngleAxisd{turn.norm(), turn.normalized()}.toRotationMatrix()
                           : Eigen::Matrix3d::Identity();
}

std::optional<ElasticityFault> fault_of(const Orthotropy& elasticity) {
  if (!are_positive(elasticity.moduli)) {
    return ElasticityFault{"youngs_moduli_pa", "each must be greater than 0"};
  }
  if (!are_positive(elasticity.shear_moduli)) {
    return ElasticityFault{"shear_moduli_pa", "each must be greater than 0"};
  }
  if (!std::ranges::all_of(elasticity.rotation_rad,
                           [](double part) { return std::isfinite(part); })) {
    return ElasticityFault{"axes_rotation_rad", "is not finite"};
  }
  for (std::size_t pair = 0; pair < Orthotropy::pairs.size(); ++pair) {
    if (auto fault = fault_of_pair(elasticity, pair)) {
      return fault;
    }
  }
  const double left = determinant(elasticity);
  if (left >= least_determinant) {
    return std::nullopt;
  }
  return ElasticityFault{
      "poissons_ratios",
      fmt::format(
          "1 - nu_12 nu_21 - nu_13 nu_31 - nu_23 nu_32 - 2 nu_21 nu_32 nu_13 = {:.4g}, "
          "which is to exceed 0 (by {:g}, for rounding; nu_ji = nu_ij E_j / E_i): the solid "
          "would give energy when it is strained",
          left, least_determinant)};
}

std::string content_key(const std::optional<Orthotropy>& elasticity) {
  if (!elasticity) {
    return {};
  }
  return fmt::format(" orthotropic({:a};{:a};{:a};{:a})", fmt::join(elasticity->moduli, ","),
                     fmt::join(elasticity->poissons_ratios, ","),
                     fmt::join(elasticity->shear_moduli, ","),
                     fmt::join(elasticity->rotation_rad, ","));
}
}  // namespace tapstudy::core
