#pragma once
#include <Eigen/Core>
#include <vector>

#include "analysis/modal/response/frequency_responses.hpp"
namespace tapstudy::analysis {
// How frequencies become angles: f0 is the first one, 0, the last one pi.
struct AngleMap {
  double low_hz{};
  double high_hz{};
  double angle(double frequency_hz) const;
  // The pole s [1/s], in the upper half plane, of a root z within it.
  std::complex<double> pole_of_root(const std::complex<double>& root) const;
};

// The least-squares complex frequency-domain estimator for several references (Guillaume,
// Verboven, Vanlanduit, Van der Auweraer & Peeters 2003; Peeters, Van der Auweraer, Guillaume &
// Leuridan 2004). Each output o is a row H_o = B_o(z) A(z)^-1, polynomials in z = e^(j angle) with
// real coefficients, A common to all, B_o a row and A a square matrix of as many columns as inputs.
// The linearised error B_o - H_o A is least in B_o by the reduced normal equations
//   D = sum over o of T_o - S_o' R^-1 S_o,  D [A_0; A_1; ...] = 0,
// with A_0 = 1, so that roots which the data do not ask for lie outside the unit circle and count
// as unstable (Cauberghe et al. 2005). R, S_o, T_o consist of blocks that depend on the difference
// of two powers alone.
class NormalEquations {
 public:
  // Each output's row is divided by its root mean square.
  NormalEquations(const FrequencyResponses& responses, const ResponseGrid& grid, int max_order);

  Eigen::Index inputs() const { return inputs_; }
  int max_order() const { return static_cast<int>(denominators_.size()); }
  // The blocks A_1 ... A_order, one below the other; 1 <= order <= max_order().
  const Eigen::MatrixXd& denominator(int order) const {
    return denominators_[static_cast<std::size_t>(order - 1)];
  }

 private:
  Eigen::Index inputs_;
  std::vector<Eigen::MatrixXd> denominators_;
};
}  // namespace tapstudy::analysis
