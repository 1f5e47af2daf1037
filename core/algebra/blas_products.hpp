#pragma once
#include <Eigen/Core>
namespace tapstudy::core {
// Products of matrices that are far higher than wide, by BLAS: it uses what the processor has,
// which a program for all of them cannot. Columns must be contiguous.
using Tall = Eigen::Ref<const Eigen::MatrixXd>;

// A' B
Eigen::MatrixXd inner_products(const Tall& a, const Tall& b);
// to -= A weights
void subtract_combination(const Tall& a, const Eigen::MatrixXd& weights, Eigen::MatrixXd& to);
// A weights
Eigen::MatrixXd combination(const Tall& a, const Eigen::MatrixXd& weights);
}  // namespace tapstudy::core
