#pragma once
#include <Eigen/Core>
#include <complex>
#include <vector>

#include "analysis/modal/response/frequency_responses.hpp"
namespace tapstudy::analysis {
// The modal model of a response, of order m of derivative,
//   H(s) = s^m (sum over modes of R / (s - p) + R* / (s - p*), + U + L / s^2),
// linear in the real and imaginary parts of the residues R and of the upper and lower residual, U
// and L, which stand for the modes above and below the band, rigid motions among the latter. s and
// p are in units of unit_rad_per_s.
struct ModalBasis {
  double unit_rad_per_s{};
  // Columns Re R, Im R of each mode, then Re U, Im U, Re L, Im L; imaginary parts below the real.
  Eigen::MatrixXd columns;
  // Columns of the same squared denominators: dH / d Re p = Re R * first + Im R * second,
  // dH / d Im p = Re R * second - Im R * first, of each mode.
  Eigen::MatrixXd slopes;
};
inline constexpr Eigen::Index residual_columns = 4;

// poles: s in rad/s, in the upper half plane.
ModalBasis modal_basis(const Eigen::ArrayXd& frequency_hz, ResponseKind kind,
                       const std::vector<std::complex<double>>& poles);

// Q R = A by Cholesky's factor of A' A, twice (Yamamoto et al. 2015), of columns scaled to one
// length: those that depend on the ones before are 0 in Q.
struct OrthonormalBasis {
  explicit OrthonormalBasis(const Eigen::MatrixXd& A);
  Eigen::MatrixXd Q;
  Eigen::MatrixXd R;
  // R^-1, with 0 for what depends on others.
  Eigen::MatrixXd inverse_of_r() const;
};
}  // namespace tapstudy::analysis
