#pragma once
#include <Eigen/Cholesky>
namespace tapstudy::core {
// Dense linear systems by Eigen, whose factorisations are templates that take each source some
// seconds to compile, for each size anew: these are compiled once. For set-up and analysis: what a
// tick calls may not allocate, and takes Eigen's of a fixed size, as inner loops do.

// A = L D L' with pivots, A symmetric, positive or negative semidefinite; only its lower triangle
// is read. Directions of which A says nothing get no part of a solution.
class SymmetricFactors {
 public:
  explicit SymmetricFactors(const Eigen::MatrixXd& A);
  // A x = b, and A X = B
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  Eigen::MatrixXd solve_columns(const Eigen::MatrixXd& B) const;
  Eigen::VectorXd pivots() const;  // D
  bool succeeded() const;          // false if a pivot is 0 and its column is not, or is no number

 private:
  Eigen::LDLT<Eigen::MatrixXd> factors_;
};

// The shortest x among those that minimise |A x - b|. Columns of A beyond those whose pivots, in an
// orthogonal factorisation, are at least least_pivot of the largest are taken for combinations of
// them; least_squares of lapack.hpp decides that by itself, at the limit of rounding.
Eigen::VectorXd shortest_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                                  double least_pivot);
}  // namespace tapstudy::core
