#pragma once
#include <Eigen/Core>
namespace tapstudy::core {
// Products of tall, narrow matrices by BLAS, which dispatches to the processor's vector
// instructions; a portable build cannot. Columns must be contiguous.
using Tall = Eigen::Ref<const Eigen::MatrixXd>;

// A' B
Eigen::MatrixXd inner_products(const Tall& a, const Tall& b);
// A' A
Eigen::MatrixXd gram(const Tall& a);
// to -= A weights
void subtract_combination(const Tall& a, const Eigen::MatrixXd& weights, Eigen::MatrixXd& to);
// A weights
Eigen::MatrixXd combination(const Tall& a, const Eigen::MatrixXd& weights);

// One thread for BLAS and LAPACK from now on, unless the environment has OPENBLAS_NUM_THREADS. Idle
// threads of OpenBLAS yield in a loop: on two processors they took a third of the time of an
// identification, and gained a seventh of that of a modal analysis with 350 000 degrees of freedom.
void use_one_blas_thread();
}  // namespace tapstudy::core
