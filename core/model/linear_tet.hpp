#pragma once
#include <Eigen/Core>

#include "core/model/material.hpp"
namespace tapstudy::core {
// The element matrices of the linear tetrahedron, degrees of freedom x0 y0 z0 x1 … z3.
struct LinearTet {
  Eigen::Matrix<double, 12, 12> stiffness;  // N/m
  Eigen::Matrix<double, 12, 12> mass;       // kg
};
using TetCorners = Eigen::Matrix<double, 4, 3>;  // one corner a row [m], positive volume

// Hooke's law for engineering strains xx yy zz xy yz zx [Pa].
Eigen::Matrix<double, 6, 6> elasticity_matrix(const Material& material);

LinearTet linear_tet(const TetCorners& corners_m, const Eigen::Matrix<double, 6, 6>& elasticity_pa,
                     double density_kg_per_m3);
}  // namespace tapstudy::core
