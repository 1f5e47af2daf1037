#include "core/model/linear_tet.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "support/plates.hpp"
using namespace tapstudy;
using Vector12 = Eigen::Matrix<double, 12, 1>;
using Matrix3 = Eigen::Matrix3d;

namespace {
core::TetCorners slanted_corners() {
  core::TetCorners corners;
  corners << 0.1, 0.0, 0.02, 1.1, 0.1, 0.0, 0.3, 0.9, -0.1, 0.2, 0.3, 0.7;
  return corners;
}
double volume(const core::TetCorners& c) {
  const Eigen::RowVector3d a = c.row(1) - c.row(0);
  const Eigen::RowVector3d b = c.row(2) - c.row(0);
  return a.cross(b).dot(c.row(3) - c.row(0)) / 6.0;
}
// Displacements u = G x of the corners.
Vector12 displaced(const core::TetCorners& corners, const Matrix3& gradient) {
  Vector12 u;
  for (Eigen::Index i = 0; i < 4; ++i) {
    u.segment<3>(3 * i) = gradient * corners.row(i).transpose();
  }
  return u;
}
core::LinearTet element() {
  return core::linear_tet(slanted_corners(), core::elasticity_matrix(testing::mdf()), 610.0);
}
}  // namespace

TEST_CASE("moving or turning an element as a whole stores no energy", "[core][element]") {
  const core::LinearTet tet = element();
  const double scale = tet.stiffness.norm();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Vector12 shift = Eigen::Vector3d::Unit(axis).replicate<4, 1>();
    CHECK((tet.stiffness * shift).norm() < 1e-12 * scale);
    Matrix3 spin = Matrix3::Zero();
    spin((axis + 1) % 3, (axis + 2) % 3) = 1.0;
    spin((axis + 2) % 3, (axis + 1) % 3) = -1.0;
    CHECK((tet.stiffness * displaced(slanted_corners(), spin)).norm() < 1e-12 * scale);
  }
}

TEST_CASE("apart from those six the stiffness is positive", "[core][element]") {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 12, 12>> solver{element().stiffness};
  CHECK(solver.eigenvalues()[5] < 1e-9 * solver.eigenvalues()[11]);
  CHECK(solver.eigenvalues()[6] > 1e-6 * solver.eigenvalues()[11]);
}

TEST_CASE("a constant strain stores the energy of Hooke's law (patch test)", "[core][element]") {
  Matrix3 gradient;
  gradient << 1e-3, 2e-4, -1e-4, 3e-4, -5e-4, 7e-4, 2e-4, 1e-4, 4e-4;
  const Matrix3 strain = 0.5 * (gradient + gradient.transpose());
  const double shear = 2.5e9 / (2.0 * 1.25);
  const double lame = 2.5e9 * 0.25 / (1.25 * 0.5);
  const double density =
      0.5 * lame * strain.trace() * strain.trace() + shear * strain.squaredNorm();
  const Vector12 u = displaced(slanted_corners(), gradient);
  CHECK(0.5 * u.dot(element().stiffness * u) == Approx(density * volume(slanted_corners())));
}

TEST_CASE("an element's mass is its density times its volume along each axis", "[core][element]") {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Vector12 shift = Eigen::Vector3d::Unit(axis).replicate<4, 1>();
    CHECK(shift.dot(element().mass * shift) == Approx(610.0 * volume(slanted_corners())));
  }
}

TEST_CASE("the consistent mass gives a linear velocity field its exact kinetic energy",
          "[core][element]") {
  // the integral of x² over a tetrahedron is V/20 (sum of x_i² + (sum of x_i)²)
  Matrix3 gradient = Matrix3::Zero();
  gradient(0, 0) = 1.0;
  const Vector12 velocity = displaced(slanted_corners(), gradient);
  const Eigen::Vector4d x = slanted_corners().col(0);
  const double exact = volume(slanted_corners()) / 20.0 * (x.squaredNorm() + x.sum() * x.sum());
  CHECK(velocity.dot(element().mass * velocity) == Approx(610.0 * exact));
}
