#pragma once
#include <Eigen/Core>
#include <complex>
#include <vector>
namespace tapstudy::analysis {
// A structure that rings freely after a tap, y_n = sum over modes of Re(c z^n), z = exp(s / rate),
// s = -zeta w + i w sqrt(1 - zeta^2), w = 2 pi frequency_hz.
struct FreeDecay {
  double rate_hz{};
  Eigen::VectorXd samples;
  double duration_s() const { return static_cast<double>(samples.size()) / rate_hz; }
};

struct Band {
  double low_hz{};
  double high_hz{};
  bool holds(double frequency_hz) const {
    return low_hz <= frequency_hz && frequency_hz <= high_hz;
  }
};

// One pair of conjugate poles.
struct Pole {
  double frequency_hz{};   // natural frequency without damping, |s| / 2 pi
  double damping_ratio{};  // -Re s / |s|
};

// The distance within which two frequencies count as one mode: the largest of this share of the
// frequency, a sixth of the half-power bandwidth (2 damping_ratio frequency_hz) and four standard
// errors.
double frequency_tolerance_hz(const Pole& pole, double share, double error_hz = 0.0);

// ln z of the pole with the positive imaginary part, and back. |damping_ratio| < 1.
std::complex<double> log_of(const Pole& pole, double rate_hz);
Pole pole_of(const std::complex<double>& log_z, double rate_hz);

// Filtered (Kaiser window, 70 dB) and decimated to at least four times high_hz. Only those outputs
// for which the filter lies inside the decay are kept, so that poles stay as they are: filtering an
// exponential multiplies it by a constant. The decay itself where the rate is low enough.
FreeDecay decimated(const FreeDecay& decay, double high_hz);

// The samples less their mean; nothing of nothing, as before a recording's first blow.
FreeDecay about_mean(const FreeDecay& decay);

// The discrete Fourier transform at the bins inside a band, of the longest part of the decay, from
// its beginning, whose length has no prime factor above 5.
struct BandSpectrum {
  double rate_hz{};
  Eigen::Index length{};          // of the part transformed
  Eigen::ArrayXd rad_per_sample;  // ascending
  Eigen::VectorXcd values;
  Eigen::ArrayXcd delay;  // e^(-j rad_per_sample): of one sample
};
// Complex values as real ones, the imaginary parts below the real.
Eigen::MatrixXd stacked(const Eigen::MatrixXcd& values);
// Throws InvalidInput for a band that holds fewer than 8 bins, with how long a decay has to be.
BandSpectrum band_spectrum(const FreeDecay& decay, const Band& band);
}  // namespace tapstudy::analysis
