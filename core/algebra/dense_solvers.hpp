#pragma once
#include <Eigen/Cholesky>
namespace tapstudy::core {
// Dense linear systems by Eigen, whose factorisations are templates: each takes a source that names
// it some seconds to compile, several times that with another size, so they are instantiated here
// alone. For set-up and analysis: what a tick calls may not allocate.

// A = L D L' with pivots, A symmetric, positive or negative semidefinite; only its lower triangle
// is read. Directions of which A says nothing get no part of a solution.
class SymmetricFactors {
 public:
  explicit SymmetricFactors(const Eigen::MatrixXd& A);
  // A x = b, and A X = B
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  Eigen::MatrixXd solve_columns(const Eigen::MatrixXd& B) const;
  Eigen::VectorXd pivots() const;  // D
  bool succeeded() const;          // false if an entry is not a number

 private:
  Eigen::LDLT<Eigen::MatrixXd> factors_;
};

// The shortest x among those that minimise |A x - b|. Columns of A beyond those whose pivots, in an
// orthogonal factorisation, are at least least_pivot of the largest are taken for combinations of
// them.
Eigen::VectorXd shortest_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                                  double least_pivot);
}  // namespace tapstudy::core
