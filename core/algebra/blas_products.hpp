#pragma once
#include <Eigen/Core>
namespace tapstudy::core {
// Products of tall, narrow matrices by BLAS, which dispatches to the processor's vector
// instructions; a portable build cannot. Columns must be contiguous.
using Tall = Eigen::Ref<const Eigen::MatrixXd>;

// A' B
Eigen::MatrixXd inner_products(const Tall& a, const Tall& b);
// to -= A weights
void subtract_combination(const Tall& a, const Eigen::MatrixXd& weights, Eigen::MatrixXd& to);
// A weights
Eigen::MatrixXd combination(const Tall& a, const Eigen::MatrixXd& weights);
}  // namespace tapstudy::core
