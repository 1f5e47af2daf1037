#include "runner/recordings/sinusoid_law.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>
namespace tapstudy::runner {
namespace {
// The surface's motion is felt through the finger's spring and damper (paper eq. 17), whatever of
// it was measured: at s = -decay + i omega displacement is velocity / s and acceleration / s^2.
double newtons_per_unit(const SinusoidLaw& law, analysis::Quantity quantity,
                        const core::Finger& finger) {
  const std::complex<double> s{-law.decay_per_s.value,
                               2.0 * std::numbers::pi * law.frequency_hz.value};
  const double per_metre = std::abs(finger.stiffness_n_per_m + finger.damping_n_s_per_m * s);
  switch (quantity) {
    case analysis::Quantity::acceleration:
      return per_metre / std::norm(s);
    case analysis::Quantity::velocity:
      return per_metre / std::abs(s);
    case analysis::Quantity::displacement:
      break;
  }
  return per_metre;
}

struct FittedTaps {
  std::vector<double> decays;
  std::vector<double> decay_errors;
  std::vector<double> frequencies;
  std::vector<double> frequency_errors;
  std::vector<double> speeds;      // of those whose speed is known
  std::vector<double> amplitudes;  // likewise, SI
  double explained{};              // sum
};

FittedTaps fitted_taps(const TapIdentification& found) {
  FittedTaps taps;
  for (const IdentifiedTap& tap : found.taps) {
    if (!tap.sinusoid || tap.sinusoid->explained < min_explained_by_sinusoid) {
      continue;
    }
    taps.decays.push_back(tap.sinusoid->decay_per_s);
    taps.decay_errors.push_back(tap.sinusoid->decay_error_per_s);
    taps.frequencies.push_back(tap.sinusoid->frequency_hz);
    taps.frequency_errors.push_back(tap.sinusoid->frequency_error_hz);
    taps.explained += tap.sinusoid->explained;
    if (tap.speed_m_s) {
      taps.speeds.push_back(*tap.speed_m_s);
      taps.amplitudes.push_back(tap.sinusoid->amplitude * found.question.si_per_unit);
    }
  }
  return taps;
}
}  // namespace

std::optional<SinusoidLaw> sinusoid_law(const TapIdentification& found,
                                        const std::optional<core::Finger>& finger) {
  constexpr double many = 1e6;  // degrees of freedom of one tap's samples
  const FittedTaps taps = fitted_taps(found);
  if (taps.decays.empty()) {
    return std::nullopt;
  }
  SinusoidLaw law;
  law.explained = taps.explained / static_cast<double>(taps.decays.size());
  law.decay_per_s = analysis::estimate_over_taps(taps.decays, taps.decay_errors, many);
  law.frequency_hz = analysis::estimate_over_taps(taps.frequencies, taps.frequency_errors, many);
  if (taps.speeds.empty()) {
    return law;
  }
  law.amplitude_per_speed = analysis::amplitude_per_speed(taps.speeds, taps.amplitudes);
  law.line = analysis::amplitude_line(taps.speeds, taps.amplitudes);
  if (finger) {
    law.amplitude_n_s_per_m =
        law.amplitude_per_speed->value * newtons_per_unit(law, found.question.quantity, *finger);
  }
  return law;
}
}  // namespace tapstudy::runner
