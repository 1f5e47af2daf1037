#pragma once
#include <Eigen/Core>
namespace tapstudy::analysis {
// The modal assurance criterion of two shapes at the same places (Allemang & Brown 1982): (a.b)^2 /
// (a.a b.b), 1 for shapes in proportion, 0 for orthogonal ones or none.
double modal_assurance(const Eigen::VectorXd& a, const Eigen::VectorXd& b);
}  // namespace tapstudy::analysis
