#pragma once
#include "analysis/modal_identification/free_decay.hpp"
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
}  // namespace tapstudy::analysis
