#include "core/algebra/lapack.hpp"

#include <algorithm>
#include <complex>

#include "core/random/rng.hpp"
#include "support/catch.hpp"
using namespace tapstudy;

namespace {
Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
  core::Rng rng{seed};
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return rng.normal(); });
}
}  // namespace

TEST_CASE("the eigenvalues of a companion matrix are the roots of its polynomial",
          "[core][algebra]") {
  // (x - 2)(x + 3)(x^2 - 2 x + 5): roots 2, -3, 1 +- 2j
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(4, 4);
  companion.row(0) << 1.0, 3.0, -17.0, 30.0;
  companion.bottomLeftCorner(3, 3).setIdentity();
  const Eigen::VectorXcd values = core::eigenvalues(companion);
  for (const std::complex<double> root :
       {std::complex{2.0, 0.0}, {-3.0, 0.0}, {1.0, 2.0}, {1.0, -2.0}}) {
    CHECK((values.array() - root).abs().minCoeff() < 1e-9);
  }
  CHECK(core::eigenvalues(Eigen::MatrixXd{0, 0}).size() == 0);
}

TEST_CASE("the pseudo-inverse meets Penrose's four conditions, of a singular matrix too",
          "[core][algebra]") {
  const Eigen::MatrixXd factor = random_matrix(6, 4, 1);
  const Eigen::MatrixXd A = factor * factor.transpose();
  const Eigen::MatrixXd inverse = core::pseudo_inverse(A);
  CHECK((A * inverse * A - A).norm() < 1e-9 * A.norm());
  CHECK((inverse * A * inverse - inverse).norm() < 1e-9 * inverse.norm());
  CHECK((A * inverse - (A * inverse).transpose()).norm() < 1e-9);
  CHECK((inverse * A - (inverse * A).transpose()).norm() < 1e-9);
}
