#include "core/model/elements/elastic_stiffness.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
namespace tapstudy::core {
namespace {
using Tensor = Eigen::Matrix<double, 9, 9>;  // C_ijkl: row 3 i + j, column 3 k + l

constexpr Eigen::Index row_of(Eigen::Index i, Eigen::Index j) {
  return 3 * i + j;
}

// In the material's own axes. The compliance of normal stresses is 1 / E_i on its diagonal and
// -nu_ij / E_i beside it; each shear has a modulus of its own (Jones, Mechanics of Composite
// Materials, 1975, section 2.4).
Tensor in_own_axes(double youngs_modulus_pa, const Orthotropy& elasticity) {
  Eigen::Matrix3d compliance;
  Tensor tensor = Tensor::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    compliance(i, i) = 1.0 / elasticity.moduli.at(static_cast<std::size_t>(i));
  }
  for (std::size_t n = 0; n < Orthotropy::pairs.size(); ++n) {
    const auto& [i, j] = Orthotropy::pairs.at(n);
    compliance(i, j) = -elasticity.poissons_ratios.at(n) * compliance(i, i);
    compliance(j, i) = compliance(i, j);
    const double shear_pa = youngs_modulus_pa * elasticity.shear_moduli.at(n);
    for (const Eigen::Index row : {row_of(i, j), row_of(j, i)}) {
      tensor(row, row_of(i, j)) = shear_pa;
      tensor(row, row_of(j, i)) = shear_pa;
    }
  }
  const Eigen::Matrix3d normal_pa = youngs_modulus_pa * compliance.inverse();
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      tensor(row_of(i, i), row_of(j, j)) = normal_pa(i, j);
    }
  }
  return tensor;
}

// C_ijkl = R_ip R_jq R_kr R_ls C_pqrs, the columns of R being the material's axes.
Tensor in_body_frame(const Tensor& own, const Eigen::Matrix3d& axes) {
  Tensor turn;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      for (Eigen::Index p = 0; p < 3; ++p) {
        for (Eigen::Index q = 0; q < 3; ++q) {
          turn(row_of(i, j), row_of(p, q)) = axes(i, p) * axes(j, q);
        }
      }
    }
  }
  return turn * own * turn.transpose();
}
}  // namespace

ElasticStiffness::ElasticStiffness(const Material& material) {
  if (material.orthotropy) {
    blocks_ = orthotropic_blocks(material);
    return;
  }
  const double youngs = material.youngs_modulus_pa;
  const double poisson = material.poissons_ratio;
  lambda_ = youngs * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
  shear_ = youngs / (2.0 * (1.0 + poisson));
}

ElasticStiffness::Blocks ElasticStiffness::orthotropic_blocks(const Material& material) {
  const Orthotropy& elasticity = *material.orthotropy;
  const Tensor tensor = in_body_frame(in_own_axes(material.youngs_modulus_pa, elasticity),
                                      rotation(elasticity.rotation_rad));
  Blocks blocks;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      for (Eigen::Index k = 0; k < 3; ++k) {
        for (Eigen::Index l = 0; l < 3; ++l) {
          blocks(i + 3 * k, j + 3 * l) = tensor(row_of(i, j), row_of(k, l));
        }
      }
    }
  }
  return blocks;
}

// Of an isotropic material lambda P + shear (P' + tr(P) I).
Eigen::Matrix3d ElasticStiffness::block(const Eigen::Matrix3d& products) const {
  Eigen::Matrix3d block;
  if (blocks_) {
    block.reshaped() = *blocks_ * products.reshaped();
    return block;
  }
  block = lambda_ * products + shear_ * products.transpose();
  block.diagonal().array() += shear_ * products.trace();
  return block;
}
}  // namespace tapstudy::core
