#pragma once
#include <vector>

#include "analysis/modal/decay/free_decay.hpp"
namespace tapstudy::analysis {
// The transform of z^n, n = 0 ... N - 1, at a spectrum's bins: (1 - z^N) / (1 - z q), q = e^(-jw).
// As sum and difference with that of the conjugate: Re(c z^n) has Re c plus + j Im c minus.
struct CutExponential {
  Eigen::VectorXcd plus;   // (of z + of its conjugate) / 2
  Eigen::VectorXcd minus;  // (of z - of its conjugate) / 2
};
CutExponential cut_exponential(const std::complex<double>& log_z, const BandSpectrum& spectrum);

// The derivative of the transform of Re(c z^n) along Re ln z (plus) and, over j, along Im ln z
// (minus).
CutExponential cut_exponential_slope(const std::complex<double>& c,
                                     const std::complex<double>& log_z,
                                     const BandSpectrum& spectrum);

// Modes, steady lines and what modes outside the band leave in it, as the transform of one decay.
// The transform of a damped exponential cut off after N samples, (1 - z^N) / (1 - z q), q =
// e^(-jw), is exact: a rectangular window leaks nothing that is not in the model. A drift
// 1 / (1 - q) and 1, q, q^2 take up what lies outside the band.
//
// Unknowns: for each pole Re ln z and Im ln z, times the length; then a and b of Re((a - j b) z^n)
// for each, then the nuisance terms. Complex values as two real ones each, below one another.
class DecayModel {
 public:
  // The spectrum must outlive it.
  DecayModel(const BandSpectrum& spectrum, Eigen::Index poles, const std::vector<double>& lines_hz);

  struct State {
    Eigen::VectorXd logs;    // 2 a pole
    Eigen::VectorXd shares;  // 2 a pole and the nuisance terms: least squares for these poles
    Eigen::MatrixXd basis;
    Eigen::MatrixXd gram;  // basis' basis
    Eigen::VectorXd residual;
    double sum_of_squares{};  // infinite for poles that grow beyond all bounds
  };
  State at(const Eigen::VectorXd& logs) const;
  // d model / d unknowns: of the poles; of the shares it is the basis.
  Eigen::MatrixXd pole_slopes(const State& state) const;
  // J' J of the derivatives by all unknowns: poles, then shares.
  Eigen::MatrixXd information(const State& state, const Eigen::MatrixXd& pole_slopes) const;
  // The derivatives of one pole's two columns of the basis, by Re of its log, then by Im: four.
  Eigen::MatrixXd column_slopes(const State& state, Eigen::Index pole) const;

  // The logarithms at which a fit can begin: growing poles are limited to a factor of e^30 over the
  // decay.
  Eigen::VectorXd logs_of(const std::vector<Pole>& poles) const;
  std::complex<double> log_of_pole(const Eigen::VectorXd& logs, Eigen::Index k) const {
    return {logs[2 * k] / length_, logs[2 * k + 1] / length_};
  }
  Eigen::Index unknowns() const { return 4 * poles_ + nuisance_.cols(); }
  Eigen::Index poles() const { return poles_; }
  double length() const { return length_; }
  double rate_hz() const { return spectrum_.rate_hz; }
  const Eigen::VectorXd& data() const { return data_; }

 private:
  const BandSpectrum& spectrum_;
  Eigen::Index poles_;
  double length_;
  Eigen::VectorXd data_;
  Eigen::MatrixXd nuisance_;
};
}  // namespace tapstudy::analysis
