#include "core/algebra/blas.hpp"

#include <cblas.h>

#include <cstdlib>
namespace tapstudy::core {
namespace {
int blas_int(Eigen::Index size) {
  return static_cast<int>(size);
}

void add_product(double scale, const Tall& a, const Eigen::MatrixXd& weights, Eigen::MatrixXd& to) {
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, blas_int(a.rows()),
              blas_int(weights.cols()), blas_int(a.cols()), scale, a.data(),
              blas_int(a.outerStride()), weights.data(), blas_int(weights.rows()), 1.0, to.data(),
              blas_int(to.rows()));
}
}  // namespace

Eigen::MatrixXd inner_products(const Tall& a, const Tall& b) {
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(a.cols(), b.cols());
  if (products.size() > 0) {
    cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, blas_int(a.cols()), blas_int(b.cols()),
                blas_int(a.rows()), 1.0, a.data(), blas_int(a.outerStride()), b.data(),
                blas_int(b.outerStride()), 0.0, products.data(), blas_int(products.rows()));
  }
  return products;
}

Eigen::MatrixXd gram(const Tall& a) {
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(a.cols(), a.cols());
  if (products.size() > 0) {
    cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, blas_int(a.cols()), blas_int(a.rows()), 1.0,
                a.data(), blas_int(a.outerStride()), 0.0, products.data(),
                blas_int(products.rows()));
  }
  return products.selfadjointView<Eigen::Lower>();
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

void use_one_blas_thread() {
  if (std::getenv("OPENBLAS_NUM_THREADS") == nullptr) {
    openblas_set_num_threads(1);
  }
}
}  // namespace tapstudy::core
