#include "core/algebra/blas_products.hpp"

#include <cblas.h>
namespace tapstudy::core {
namespace {
int as_int(Eigen::Index size) {
  return static_cast<int>(size);
}

void add_product(double scale, const Tall& a, const Eigen::MatrixXd& weights, Eigen::MatrixXd& to) {
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, as_int(a.rows()), as_int(weights.cols()),
              as_int(a.cols()), scale, a.data(), as_int(a.outerStride()), weights.data(),
              as_int(weights.rows()), 1.0, to.data(), as_int(to.rows()));
}
}  // namespace

Eigen::MatrixXd inner_products(const Tall& a, const Tall& b) {
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(a.cols(), b.cols());
  if (products.size() > 0) {
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, as_int(a.cols()), as_int(b.cols()),
                as_int(a.rows()), 1.0, a.data(), as_int(a.outerStride()), b.data(),
                as_int(b.outerStride()), 0.0, products.data(), as_int(products.rows()));
  }
  return products;
}

void subtract_combination(const Tall& a, const Eigen::MatrixXd& weights, Eigen::MatrixXd& to) {
  if (weights.size() > 0) {
    add_product(-1.0, a, weights, to);
  }
}

Eigen::MatrixXd combination(const Tall& a, const Eigen::MatrixXd& weights) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(a.rows(), weights.cols());
  if (weights.size() > 0) {
    add_product(1.0, a, weights, sum);
  }
  return sum;
}
}  // namespace tapstudy::core
