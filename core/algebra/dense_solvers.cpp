#include "core/algebra/dense_solvers.hpp"

#include <Eigen/QR>
namespace tapstudy::core {
SymmetricFactors::SymmetricFactors(const Eigen::MatrixXd& A) : factors_{A} {}

Eigen::VectorXd SymmetricFactors::solve(const Eigen::VectorXd& b) const {
  return factors_.solve(b);
}
Eigen::MatrixXd SymmetricFactors::solve_columns(const Eigen::MatrixXd& B) const {
  return factors_.solve(B);
}
Eigen::VectorXd SymmetricFactors::pivots() const {
  return factors_.vectorD();
}
bool SymmetricFactors::succeeded() const {
  return factors_.info() == Eigen::Success;
}

Eigen::VectorXd shortest_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                                  double least_pivot) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors{A.rows(), A.cols()};
  factors.setThreshold(least_pivot);
  return factors.compute(A).solve(b);
}
}  // namespace tapstudy::core
