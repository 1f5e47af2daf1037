#pragma once
#include <Eigen/Core>
namespace tapstudy::core {
// Dense eigenproblems and least squares by LAPACK (Anderson et al. 1999): Eigen's own solvers are
// templates that take many times longer to compile and run no faster.

struct EigenPairs {
  Eigen::VectorXd values;   // ascending
  Eigen::MatrixXd vectors;  // one column per value
};
// A x = lambda x, A symmetric, only its lower triangle is read; vectors orthonormal.
// Throws ModelError if the iteration does not converge.
EigenPairs symmetric_eigenpairs(Eigen::MatrixXd A);
// A x = lambda B x, A symmetric, B positive definite; vectors B-orthonormal.
// Throws ModelError also if B is not positive definite.
EigenPairs symmetric_eigenpairs(Eigen::MatrixXd A, Eigen::MatrixXd B);

// All eigenvalues of a symmetric A, only whose lower triangle is read, and the orthonormal vectors
// of the `count` largest alone, ascending likewise. Throws ModelError likewise.
EigenPairs largest_eigenpairs(Eigen::MatrixXd A, Eigen::Index count);

// The eigenvalues of any real square matrix, in no order; complex ones in conjugate pairs.
// Throws ModelError if the iteration does not converge or an entry is not a number.
Eigen::VectorXcd eigenvalues(Eigen::MatrixXd A);

// The Moore-Penrose inverse of a symmetric positive semidefinite matrix; only its lower triangle is
// read. Throws ModelError as symmetric_eigenpairs does.
Eigen::MatrixXd pseudo_inverse(Eigen::MatrixXd A);

struct LeastSquares {
  Eigen::VectorXd solution;  // of least norm among those that minimise |A x - b|
  int rank{};
};
// A: m × n, m >= n, columns of similar norm, otherwise rank detection fails.
// Throws ModelError if an entry is not a number.
LeastSquares least_squares(Eigen::MatrixXd A, Eigen::VectorXd b);
// Where gram, A' A, is known; columns of any norm.
LeastSquares least_squares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& gram,
                           const Eigen::VectorXd& b);
}  // namespace tapstudy::core
