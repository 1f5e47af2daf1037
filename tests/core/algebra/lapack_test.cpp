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

TEST_CASE("the largest eigenpairs are those of all", "[core][algebra]") {
  const Eigen::MatrixXd factor = random_matrix(40, 25, 3);  // 15 eigenvalues are 0
  const Eigen::MatrixXd A = factor * factor.transpose();
  const core::EigenPairs all = core::symmetric_eigenpairs(A);
  for (const Eigen::Index count : {0, 1, 7, 40}) {
    const core::EigenPairs some = core::largest_eigenpairs(A, count);
    CHECK((some.values - all.values).norm() < 1e-12 * all.values.norm());
    CHECK((A * some.vectors - some.vectors * some.values.tail(count).asDiagonal()).norm() <
          1e-12 * A.norm());
    CHECK(
        (some.vectors.transpose() * some.vectors - Eigen::MatrixXd::Identity(count, count)).norm() <
        1e-12);
  }
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
