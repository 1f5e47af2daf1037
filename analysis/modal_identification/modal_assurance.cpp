#include "analysis/modal_identification/modal_assurance.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
namespace tapstudy::analysis {
namespace {
// At the impact, per unit of impulse.
std::complex<double> excited(const ModeInTap& mode, const PlacedTap& tap) {
  const Pole& pole = mode.fitted.pole;
  const double omega = 2.0 * std::numbers::pi * pole.frequency_hz;
  const double ratio = pole.damping_ratio;
  const std::complex<double> s{-ratio * omega, omega * std::sqrt(1.0 - ratio * ratio)};
  return std::polar(mode.fitted.amplitude, mode.fitted.phase_rad) *
         std::exp(-s * tap.since_impact_s) / tap.impulse;
}
}  // namespace

double modal_assurance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const double norms = a.squaredNorm() * b.squaredNorm();
  const double product = a.dot(b);
  return norms > 0.0 ? product * product / norms : 0.0;
}

Eigen::VectorXd tapped_shape(const RepeatedMode& mode, const std::vector<PlacedTap>& taps,
                             std::size_t places) {
  const auto count = static_cast<Eigen::Index>(places);
  Eigen::VectorXd shape = Eigen::VectorXd::Zero(count);
  Eigen::VectorXd taps_at = Eigen::VectorXd::Zero(count);
  std::vector<std::complex<double>> amplitudes;
  for (const ModeInTap& one : mode.in_taps) {
    amplitudes.push_back(excited(one, taps[one.tap]));
  }
  const std::complex<double> largest = *std::ranges::max_element(
      amplitudes, {}, [](const std::complex<double>& one) { return std::abs(one); });
  for (std::size_t i = 0; i < amplitudes.size(); ++i) {
    const double sign = (amplitudes[i] * std::conj(largest)).real() < 0.0 ? -1.0 : 1.0;
    shape[static_cast<Eigen::Index>(taps[mode.in_taps[i].tap].place)] +=
        sign * std::abs(amplitudes[i]);
  }
  for (const PlacedTap& tap : taps) {
    taps_at[static_cast<Eigen::Index>(tap.place)] += 1.0;
  }
  return shape.cwiseQuotient(taps_at.cwiseMax(1.0));
}
}  // namespace tapstudy::analysis
