#pragma once
#include <Eigen/Core>
#include <optional>

#include "core/model/elements/material.hpp"
namespace tapstudy::core {
// The elasticity C_ijkl of a material in the body's frame.
class ElasticStiffness {
 public:
  explicit ElasticStiffness(const Material& material);
  // The block of K of two nodes a and b: the sum over j, l of C_ijkl P_jl, where P_jl is the
  // integral of d_j N_a d_l N_b over the element [m].
  Eigen::Matrix3d block(const Eigen::Matrix3d& products) const;

 private:
  using Blocks = Eigen::Matrix<double, 9, 9>;
  static Blocks orthotropic_blocks(const Material& material);
  // Lamé's constants [Pa], of an isotropic material.
  double lambda_{};
  double shear_{};
  std::optional<Blocks> blocks_;  // of an orthotropic one: row i + 3 k, column j + 3 l
};
}  // namespace tapstudy::core
