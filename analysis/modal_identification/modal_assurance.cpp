#include "analysis/modal_identification/modal_assurance.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <set>
#include <utility>
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

namespace {
Eigen::VectorXd shape_seen_by(const std::string& channel, const RepeatedMode& mode,
                              const std::vector<PlacedTap>& taps, std::size_t places) {
  const auto count = static_cast<Eigen::Index>(places);
  Eigen::VectorXd shape = Eigen::VectorXd::Zero(count);
  Eigen::VectorXd taps_at = Eigen::VectorXd::Zero(count);
  std::vector<std::pair<Eigen::Index, std::complex<double>>> amplitudes;
  for (const ModeInTap& one : mode.in_taps) {
    if (taps[one.tap].channel == channel) {
      amplitudes.emplace_back(static_cast<Eigen::Index>(taps[one.tap].place),
                              excited(one, taps[one.tap]));
    }
  }
  std::complex<double> largest;
  for (const auto& [place, amplitude] : amplitudes) {
    largest = std::abs(amplitude) > std::abs(largest) ? amplitude : largest;
  }
  for (const auto& [place, amplitude] : amplitudes) {
    const double sign = (amplitude * std::conj(largest)).real() < 0.0 ? -1.0 : 1.0;
    shape[place] += sign * std::abs(amplitude);
  }
  for (const PlacedTap& tap : taps) {
    taps_at[static_cast<Eigen::Index>(tap.place)] += tap.channel == channel ? 1.0 : 0.0;
  }
  return shape.cwiseQuotient(taps_at.cwiseMax(1.0));
}
}  // namespace

Eigen::VectorXd tapped_shape(const RepeatedMode& mode, const std::vector<PlacedTap>& taps,
                             std::size_t places) {
  Eigen::VectorXd clearest = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(places));
  std::set<std::string> channels;
  for (const PlacedTap& tap : taps) {
    if (channels.insert(tap.channel).second) {
      const Eigen::VectorXd shape = shape_seen_by(tap.channel, mode, taps, places);
      clearest = shape.norm() > clearest.norm() ? shape : clearest;
    }
  }
  return clearest;
}
}  // namespace tapstudy::analysis
