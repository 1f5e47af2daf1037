#include "analysis/modal/decay/free_decay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using std::numbers::pi;
constexpr double stop_band_db = 70.0;
constexpr Eigen::Index min_bins = 8;

// Low-pass by a windowed sinc (Kaiser 1974), unit gain at 0; frequencies in cycles per sample.
Eigen::VectorXd kaiser_low_pass(double pass, double stop) {
  const double beta = 0.1102 * (stop_band_db - 8.7);
  const auto half = static_cast<Eigen::Index>(
      std::ceil((stop_band_db - 8.0) / (2.285 * 2.0 * pi * (stop - pass)) / 2.0));
  Eigen::VectorXd taps{2 * half + 1};
  for (Eigen::Index i = -half; i <= half; ++i) {
    const double x = static_cast<double>(i) / static_cast<double>(half + 1);
    const double phase = pi * (pass + stop) * static_cast<double>(i);
    const double sinc = i == 0 ? 1.0 : std::sin(phase) / phase;
    taps[i + half] = sinc * std::cyl_bessel_i(0.0, beta * std::sqrt(1.0 - x * x));
  }
  return taps / taps.sum();
}

bool has_small_factors(Eigen::Index n) {
  for (const Eigen::Index factor : {2, 3, 5}) {
    while (n % factor == 0) {
      n /= factor;
    }
  }
  return n == 1;
}
}  // namespace

double frequency_tolerance_hz(const Pole& pole, double share, double error_hz) {
  const double bandwidth_hz = 2.0 * std::abs(pole.damping_ratio) * pole.frequency_hz;
  return std::max({share * pole.frequency_hz, bandwidth_hz / 6.0, 4.0 * error_hz});
}

std::complex<double> log_of(const Pole& pole, double rate_hz) {
  const double omega = 2.0 * pi * pole.frequency_hz / rate_hz;
  return {-pole.damping_ratio * omega,
          omega * std::sqrt(1.0 - pole.damping_ratio * pole.damping_ratio)};
}

Pole pole_of(const std::complex<double>& log_z, double rate_hz) {
  const double omega = std::abs(log_z);
  return {omega * rate_hz / (2.0 * pi), omega > 0.0 ? -log_z.real() / omega : 0.0};
}

FreeDecay decimated(const FreeDecay& decay, double high_hz) {
  const auto factor = static_cast<Eigen::Index>(decay.rate_hz / (4.0 * high_hz));
  if (factor < 2) {
    return decay;
  }
  const double low_rate_hz = decay.rate_hz / static_cast<double>(factor);
  const Eigen::VectorXd taps =
      kaiser_low_pass(high_hz / decay.rate_hz, (low_rate_hz - high_hz) / decay.rate_hz);
  const Eigen::Index room = decay.samples.size() - taps.size();
  FreeDecay result{low_rate_hz, Eigen::VectorXd(room < 0 ? 0 : room / factor + 1)};
  for (Eigen::Index i = 0; i < result.samples.size(); ++i) {
    result.samples[i] = taps.dot(decay.samples.segment(i * factor, taps.size()));
  }
  return result;
}

FreeDecay about_mean(const FreeDecay& decay) {
  if (decay.samples.size() == 0) {
    return decay;
  }
  return {decay.rate_hz, (decay.samples.array() - decay.samples.mean()).matrix()};
}

Eigen::MatrixXd stacked(const Eigen::MatrixXcd& values) {
  Eigen::MatrixXd all{2 * values.rows(), values.cols()};
  all << values.real(), values.imag();
  return all;
}

BandSpectrum band_spectrum(const FreeDecay& decay, const Band& band) {
  Eigen::Index length = decay.samples.size();
  while (length > 1 && !has_small_factors(length)) {
    --length;
  }
  const double bin_hz = decay.rate_hz / static_cast<double>(std::max<Eigen::Index>(length, 1));
  const auto first =
      std::max<Eigen::Index>(1, static_cast<Eigen::Index>(std::ceil(band.low_hz / bin_hz)));
  const auto last = std::min((length - 1) / 2, static_cast<Eigen::Index>(band.high_hz / bin_hz));
  if (last - first + 1 < min_bins) {
    throw core::InvalidInput{fmt::format(
        "{:.3g} s are too short for the band {:g} to {:g} Hz (at least {:.3g} s)",
        decay.duration_s(), band.low_hz, band.high_hz,
        static_cast<double>(min_bins + 1) / std::max(band.high_hz - band.low_hz, 1e-9))};
  }
  Eigen::VectorXcd spectrum;
  Eigen::FFT<double> transform;
  transform.fwd(spectrum, Eigen::VectorXd{decay.samples.head(length)});
  const Eigen::Index bins = last - first + 1;
  const Eigen::ArrayXd rad_per_sample =
      2.0 * pi / static_cast<double>(length) *
      Eigen::ArrayXd::LinSpaced(bins, static_cast<double>(first), static_cast<double>(last));
  return {decay.rate_hz, length, rad_per_sample, spectrum.segment(first, bins),
          (std::complex<double>{0.0, -1.0} * rad_per_sample.cast<std::complex<double>>()).exp()};
}
}  // namespace tapstudy::analysis
