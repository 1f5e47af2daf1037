#include "core/model/elements/tet_element.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "support/catch.hpp"
#include "support/plates.hpp"
using namespace tapstudy;
using Matrix3 = Eigen::Matrix3d;
using Nodes = Eigen::Matrix<double, Eigen::Dynamic, 3>;

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
// The element of the given order as dynamic matrices, so that one law reads the same for both.
struct Element {
  Nodes nodes;
  Eigen::MatrixXd stiffness;
  Eigen::MatrixXd mass;
};
Element element(int order) {
  const core::TetCorners c = slanted_corners();
  Nodes nodes{order == 1 ? 4 : 10, 3};
  nodes.topRows<4>() = c;
  if (order == 1) {
    const auto tet = core::tet_element<4>(c, testing::mdf());
    return {nodes, tet.stiffness, tet.mass};
  }
  const std::vector<std::pair<int, int>> edges{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  for (std::size_t e = 0; e < edges.size(); ++e) {
    nodes.row(static_cast<Eigen::Index>(4 + e)) =
        0.5 * (c.row(edges[e].first) + c.row(edges[e].second));
  }
  const auto tet = core::tet_element<10>(c, testing::mdf());
  return {nodes, tet.stiffness, tet.mass};
}
// Displacements u = G x of the nodes.
Eigen::VectorXd displaced(const Nodes& nodes, const Matrix3& gradient) {
  const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> u = nodes * gradient.transpose();
  return u.reshaped<Eigen::RowMajor>();
}
Eigen::VectorXd shifted(const Nodes& nodes, Eigen::Index axis) {
  return Eigen::Vector3d::Unit(axis).replicate(nodes.rows(), 1);
}
}  // namespace

TEST_CASE("moving or turning an element as a whole stores no energy", "[core][element]") {
  const Element tet = element(GENERATE(1, 2));
  const double scale = tet.stiffness.norm();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    CHECK((tet.stiffness * shifted(tet.nodes, axis)).norm() < 1e-12 * scale);
    Matrix3 spin = Matrix3::Zero();
    spin((axis + 1) % 3, (axis + 2) % 3) = 1.0;
    spin((axis + 2) % 3, (axis + 1) % 3) = -1.0;
    CHECK((tet.stiffness * displaced(tet.nodes, spin)).norm() < 1e-12 * scale);
  }
}

TEST_CASE("apart from those six the stiffness is positive", "[core][element]") {
  const Element tet = element(GENERATE(1, 2));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver{tet.stiffness};
  const double largest = solver.eigenvalues().maxCoeff();
  CHECK(solver.eigenvalues()[5] < 1e-9 * largest);
  CHECK(solver.eigenvalues()[6] > 1e-6 * largest);
}

TEST_CASE("a constant strain stores the energy of Hooke's law (patch test)", "[core][element]") {
  const Element tet = element(GENERATE(1, 2));
  Matrix3 gradient;
  gradient << 1e-3, 2e-4, -1e-4, 3e-4, -5e-4, 7e-4, 2e-4, 1e-4, 4e-4;
  const Matrix3 strain = 0.5 * (gradient + gradient.transpose());
  const double shear = 2.5e9 / (2.0 * 1.25);
  const double lame = 2.5e9 * 0.25 / (1.25 * 0.5);
  const double density =
      0.5 * lame * strain.trace() * strain.trace() + shear * strain.squaredNorm();
  const Eigen::VectorXd u = displaced(tet.nodes, gradient);
  CHECK(0.5 * u.dot(tet.stiffness * u) == Approx(density * volume(slanted_corners())));
}

TEST_CASE("a quadratic displacement stores its exact energy in an element of order 2",
          "[core][element]") {
  // u = (x² / 2, 0, 0): strain xx = x, energy density (lambda / 2 + shear) x²
  const Element tet = element(2);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(30);
  for (Eigen::Index i = 0; i < 10; ++i) {
    u[3 * i] = 0.5 * tet.nodes(i, 0) * tet.nodes(i, 0);
  }
  const double shear = 2.5e9 / (2.0 * 1.25);
  const double lame = 2.5e9 * 0.25 / (1.25 * 0.5);
  const Eigen::Vector4d x = slanted_corners().col(0);
  const double x_squared = volume(slanted_corners()) / 20.0 * (x.squaredNorm() + x.sum() * x.sum());
  CHECK(0.5 * u.dot(tet.stiffness * u) == Approx((0.5 * lame + shear) * x_squared));
}

TEST_CASE("an element's mass is its density times its volume", "[core][element]") {
  const Element tet = element(GENERATE(1, 2));
  CHECK(tet.mass.sum() == Approx(610.0 * volume(slanted_corners())));
}

TEST_CASE("the consistent mass gives a linear velocity field its exact kinetic energy",
          "[core][element]") {
  // the integral of x² over a tetrahedron is V/20 (sum of x_i² + (sum of x_i)²)
  const Element tet = element(GENERATE(1, 2));
  const Eigen::VectorXd velocity = tet.nodes.col(0);
  const Eigen::Vector4d x = slanted_corners().col(0);
  const double exact = volume(slanted_corners()) / 20.0 * (x.squaredNorm() + x.sum() * x.sum());
  CHECK(velocity.dot(tet.mass * velocity) == Approx(610.0 * exact));
}

TEST_CASE("a mass of order 2 is positive for every motion", "[core][element]") {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver{element(2).mass};
  CHECK(solver.eigenvalues().minCoeff() > 0.0);
}
