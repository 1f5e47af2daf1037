#include "core/model/linear_tet.hpp"

#include <Eigen/LU>
namespace tapstudy::core {
namespace {
// Rows: gradients of the four shape functions [1/m], from N_i = a_i + b_i x + c_i y + d_i z.
Eigen::Matrix<double, 4, 3> shape_gradients(const Eigen::Matrix4d& coordinates) {
  return coordinates.inverse().bottomRows<3>().transpose();
}

Eigen::Matrix<double, 6, 12> strain_matrix(const Eigen::Matrix<double, 4, 3>& gradient) {
  Eigen::Matrix<double, 6, 12> B = Eigen::Matrix<double, 6, 12>::Zero();
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double x = gradient(i, 0);
    const double y = gradient(i, 1);
    const double z = gradient(i, 2);
    B.middleCols<3>(3 * i) << x, 0, 0, 0, y, 0, 0, 0, z, y, x, 0, 0, z, y, z, 0, x;
  }
  return B;
}
}  // namespace

Eigen::Matrix<double, 6, 6> elasticity_matrix(const Material& material) {
  const double youngs = material.youngs_modulus_pa;
  const double poisson = material.poissons_ratio;
  const double shear = youngs / (2.0 * (1.0 + poisson));
  const double lame = youngs * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
  Eigen::Matrix<double, 6, 6> D = Eigen::Matrix<double, 6, 6>::Zero();
  D.topLeftCorner<3, 3>().setConstant(lame);
  D.diagonal() << lame + 2 * shear, lame + 2 * shear, lame + 2 * shear, shear, shear, shear;
  return D;
}

LinearTet linear_tet(const TetCorners& corners_m, const Eigen::Matrix<double, 6, 6>& elasticity_pa,
                     double density_kg_per_m3) {
  Eigen::Matrix4d coordinates;
  coordinates << Eigen::Vector4d::Ones(), corners_m;
  const double volume = coordinates.determinant() / 6.0;
  const Eigen::Matrix<double, 6, 12> B = strain_matrix(shape_gradients(coordinates));
  LinearTet element;
  element.stiffness = volume * B.transpose() * elasticity_pa * B;
  element.mass.setZero();
  for (Eigen::Index i = 0; i < 4; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j) {
      element.mass.block<3, 3>(3 * i, 3 * j)
          .diagonal()
          .setConstant(density_kg_per_m3 * volume / 20.0 * (i == j ? 2.0 : 1.0));
    }
  }
  return element;
}
}  // namespace tapstudy::core
