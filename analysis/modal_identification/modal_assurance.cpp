#include "analysis/modal_identification/modal_assurance.hpp"
namespace tapstudy::analysis {
double modal_assurance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const double norms = a.squaredNorm() * b.squaredNorm();
  const double product = a.dot(b);
  return norms > 0.0 ? product * product / norms : 0.0;
}
}  // namespace tapstudy::analysis
