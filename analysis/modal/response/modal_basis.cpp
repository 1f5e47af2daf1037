#include "analysis/modal/response/modal_basis.hpp"

#include <cmath>
#include <numbers>

namespace tapstudy::analysis {
namespace {
using Complex = std::complex<double>;
constexpr Complex j{0.0, 1.0};

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
  const Eigen::ArrayXcd s = j * (frequency_hz / frequency_hz[lines - 1]).cast<Complex>();
  const Eigen::ArrayXcd derivative = kind == ResponseKind::receptance
                                         ? Eigen::ArrayXcd::Ones(lines).eval()
                                         : (kind == ResponseKind::mobility ? s : (s * s).eval());
  for (Eigen::Index mode = 0; mode < modes; ++mode) {
    const Complex p = poles[static_cast<std::size_t>(mode)] / basis.unit_rad_per_s;
    const Eigen::ArrayXcd above = (s - p).inverse();
    const Eigen::ArrayXcd below = (s - std::conj(p)).inverse();
    set_column(derivative * (above + below), 2 * mode, basis.columns);
    set_column(derivative * j * (above - below), 2 * mode + 1, basis.columns);
    set_column(derivative * (above * above + below * below), 2 * mode, basis.slopes);
    set_column(derivative * j * (above * above - below * below), 2 * mode + 1, basis.slopes);
  }
  const Eigen::ArrayXcd lower = derivative / (s * s);
  set_column(derivative, 2 * modes, basis.columns);
  set_column(derivative * j, 2 * modes + 1, basis.columns);
  set_column(lower, 2 * modes + 2, basis.columns);
  set_column(lower * j, 2 * modes + 3, basis.columns);
  return basis;
}

OrthonormalBasis::OrthonormalBasis(const Eigen::MatrixXd& A)
    : Q{A}, R{Eigen::MatrixXd::Zero(A.cols(), A.cols())} {
  constexpr double dependent = 1e-12;
  for (Eigen::Index k = 0; k < Q.cols(); ++k) {
    const double whole = Q.col(k).norm();
    for (int round = 0; round < 2; ++round) {
      for (Eigen::Index i = 0; i < k; ++i) {
        const double part = Q.col(i).dot(Q.col(k));
        R(i, k) += part;
        Q.col(k) -= part * Q.col(i);
      }
    }
    const double left = Q.col(k).norm();
    if (left > dependent * whole) {
      R(k, k) = left;
      Q.col(k) /= left;
    } else {
      Q.col(k).setZero();
    }
  }
}

Eigen::MatrixXd OrthonormalBasis::inverse_of_R() const {
  const Eigen::Index n = R.rows();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index column = 0; column < n; ++column) {
    for (Eigen::Index row = column; row >= 0; --row) {
      if (R(row, row) == 0.0) {
        continue;
      }
      double sum = row == column ? 1.0 : 0.0;
      for (Eigen::Index k = row + 1; k <= column; ++k) {
        sum -= R(row, k) * inverse(k, column);
      }
      inverse(row, column) = sum / R(row, row);
    }
  }
  return inverse;
}
}  // namespace tapstudy::analysis
