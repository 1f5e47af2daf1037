#include "analysis/modal/response/modal_basis.hpp"

#include <cmath>
#include <numbers>

#include "core/algebra/blas.hpp"

namespace tapstudy::analysis {
namespace {
using Complex = std::complex<double>;
constexpr Complex imaginary_unit{0.0, 1.0};

void set_column(const Eigen::ArrayXcd& values, Eigen::Index column, Eigen::MatrixXd& all) {
  all.col(column).head(values.size()) = values.real().matrix();
  all.col(column).tail(values.size()) = values.imag().matrix();
}
}  // namespace

ModalBasis modal_basis(const Eigen::ArrayXd& frequency_hz, ResponseKind kind,
                       const std::vector<Complex>& poles) {
  const Eigen::Index lines = frequency_hz.size();
  const auto modes = std::ssize(poles);
  ModalBasis basis;
  basis.unit_rad_per_s = 2.0 * std::numbers::pi * frequency_hz[lines - 1];
  basis.columns.resize(2 * lines, 2 * modes + residual_columns);
  basis.slopes.resize(2 * lines, 2 * modes);
  const Eigen::ArrayXcd s =
      imaginary_unit * (frequency_hz / frequency_hz[lines - 1]).cast<Complex>();
  const Eigen::ArrayXcd derivative = kind == ResponseKind::receptance
                                         ? Eigen::ArrayXcd::Ones(lines).eval()
                                         : (kind == ResponseKind::mobility ? s : (s * s).eval());
  for (Eigen::Index mode = 0; mode < modes; ++mode) {
    const Complex p = poles[static_cast<std::size_t>(mode)] / basis.unit_rad_per_s;
    const Eigen::ArrayXcd above = (s - p).inverse();
    const Eigen::ArrayXcd below = (s - std::conj(p)).inverse();
    set_column(derivative * (above + below), 2 * mode, basis.columns);
    set_column(derivative * imaginary_unit * (above - below), 2 * mode + 1, basis.columns);
    set_column(derivative * (above * above + below * below), 2 * mode, basis.slopes);
    set_column(derivative * imaginary_unit * (above * above - below * below), 2 * mode + 1,
               basis.slopes);
  }
  const Eigen::ArrayXcd lower = derivative / (s * s);
  set_column(derivative, 2 * modes, basis.columns);
  set_column(derivative * imaginary_unit, 2 * modes + 1, basis.columns);
  set_column(lower, 2 * modes + 2, basis.columns);
  set_column(lower * imaginary_unit, 2 * modes + 3, basis.columns);
  return basis;
}

namespace {
// The upper triangular R with R' R = G; rows of what depends on the columns before are 0.
Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd& G) {
  constexpr double dependent = 1e-14;
  const Eigen::Index n = G.rows();
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double left = G(k, k) - R.col(k).head(k).squaredNorm();
    if (!(left > dependent * G(k, k))) {
      continue;
    }
    R(k, k) = std::sqrt(left);
    const Eigen::Index after = n - k - 1;
    R.row(k).tail(after) =
        (G.row(k).tail(after) - R.col(k).head(k).transpose() * R.block(0, k + 1, k, after)) /
        R(k, k);
  }
  return R;
}

// R^-1, with 0 for what depends on others.
Eigen::MatrixXd inverse_of_upper(const Eigen::MatrixXd& R) {
  const Eigen::Index n = R.rows();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index row = n - 1; row >= 0; --row) {
    if (R(row, row) == 0.0) {
      continue;
    }
    const Eigen::Index after = n - row - 1;
    inverse(row, row) = 1.0;
    inverse.row(row).tail(after) =
        -R.row(row).tail(after) * inverse.bottomRightCorner(after, after);
    inverse.row(row) /= R(row, row);
  }
  return inverse;
}
}  // namespace

OrthonormalBasis::OrthonormalBasis(const Eigen::MatrixXd& A) {
  const Eigen::VectorXd sizes = A.colwise().norm().cwiseMax(1e-300);
  Q = A * sizes.cwiseInverse().asDiagonal();
  R = sizes.asDiagonal();
  constexpr int rounds = 2;
  for (int round = 0; round < rounds; ++round) {
    const Eigen::MatrixXd factor = cholesky_factor(core::inner_products(Q, Q));
    Q = core::combination(Q, inverse_of_upper(factor));
    R = factor * R;
  }
}

Eigen::MatrixXd OrthonormalBasis::inverse_of_r() const {
  return inverse_of_upper(R);
}
}  // namespace tapstudy::analysis
