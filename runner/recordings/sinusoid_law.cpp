#include "runner/recordings/sinusoid_law.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <string>
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

using Fits = std::vector<const IdentifiedTap*>;

// By impact: its channels vary together.
std::map<int, Fits> fits_of(const TapIdentification& found) {
  std::map<int, Fits> fits;
  for (const IdentifiedTap& tap : found.taps) {
    if (tap.sinusoid && tap.sinusoid->explained >= min_explained_by_sinusoid) {
      fits[tap.impact].push_back(&tap);
    }
  }
  return fits;
}

double mean_of(const Fits& channels, double analysis::FittedSinusoid::*value) {
  double sum = 0.0;
  for (const IdentifiedTap* const tap : channels) {
    sum += (*tap->sinusoid).*value;
  }
  return sum / static_cast<double>(channels.size());
}

analysis::Estimate over_impacts(const std::map<int, Fits>& fits,
                                double analysis::FittedSinusoid::*value,
                                double analysis::FittedSinusoid::*error) {
  constexpr double many = 1e6;  // degrees of freedom of one tap's samples
  std::vector<double> values;
  std::vector<double> errors;
  for (const auto& [impact, channels] : fits) {
    values.push_back(mean_of(channels, value));
    errors.push_back(mean_of(channels, error));
  }
  return analysis::estimate_over_taps(values, errors, many);
}

bool is_of_one_sensor(const std::map<int, Fits>& fits) {
  const std::string& first = fits.begin()->second.front()->channel;
  return std::ranges::all_of(fits, [&](const auto& of_impact) {
    return std::ranges::all_of(of_impact.second,
                               [&](const IdentifiedTap* tap) { return tap->channel == first; });
  });
}

// Amplitudes by the speeds of impact, SI; none where speeds are not known.
void add_amplitudes(const TapIdentification& found, const std::map<int, Fits>& fits,
                    SinusoidLaw& law) {
  std::vector<double> speeds;
  std::vector<double> amplitudes;
  for (const auto& [impact, channels] : fits) {
    if (channels.front()->speed_m_s) {
      speeds.push_back(*channels.front()->speed_m_s);
      amplitudes.push_back(channels.front()->sinusoid->amplitude * found.question.si_per_unit);
    }
  }
  if (!speeds.empty()) {
    law.amplitude_per_speed = analysis::amplitude_per_speed(speeds, amplitudes);
    law.line = analysis::amplitude_line(speeds, amplitudes);
  }
}
}  // namespace

std::optional<SinusoidLaw> sinusoid_law(const TapIdentification& found,
                                        const std::optional<core::Finger>& finger) {
  const std::map<int, Fits> fits = fits_of(found);
  if (fits.empty()) {
    return std::nullopt;
  }
  SinusoidLaw law;
  int taps = 0;
  for (const auto& [impact, channels] : fits) {
    for (const IdentifiedTap* const tap : channels) {
      law.explained += tap->sinusoid->explained;
      ++taps;
    }
  }
  law.explained /= taps;
  law.decay_per_s = over_impacts(fits, &analysis::FittedSinusoid::decay_per_s,
                                 &analysis::FittedSinusoid::decay_error_per_s);
  law.frequency_hz = over_impacts(fits, &analysis::FittedSinusoid::frequency_hz,
                                  &analysis::FittedSinusoid::frequency_error_hz);
  law.is_of_one_sensor = is_of_one_sensor(fits);
  if (law.is_of_one_sensor) {
    add_amplitudes(found, fits, law);
  }
  if (finger && law.amplitude_per_speed) {
    law.amplitude_n_s_per_m =
        law.amplitude_per_speed->value * newtons_per_unit(law, found.question.quantity, *finger);
  }
  return law;
}
}  // namespace tapstudy::runner
