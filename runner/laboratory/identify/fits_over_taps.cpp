#include "runner/laboratory/identify/fits_over_taps.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
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

// Groups the fits by impact, because the channels of one impact vary together.
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
      amplitudes.push_back(channels.front()->sinusoid->amplitude *
                           found.question.scale.value_or(1.0));
    }
  }
  if (!speeds.empty()) {
    law.amplitude_per_speed = analysis::amplitude_per_speed(speeds, amplitudes);
    law.line = analysis::amplitude_line(speeds, amplitudes);
  }
}

bool is_apart(const analysis::FittedSinusoid& lower, const analysis::FittedSinusoid& higher) {
  constexpr double gap = 1.05;
  constexpr double normal_975 = 1.96;
  const double errors_hz = lower.frequency_error_hz + higher.frequency_error_hz;
  return higher.frequency_hz > gap * lower.frequency_hz &&
         higher.frequency_hz - lower.frequency_hz > normal_975 * errors_hz;
}

// Those of taps and sensors that are dominated by different modes: between neighbours is a gap of
// more than 5 %, beyond the intervals of both. Taps that merely scatter have one.
std::vector<double> different_frequencies(const std::map<int, Fits>& fits) {
  std::vector<analysis::FittedSinusoid> all;
  for (const auto& [impact, channels] : fits) {
    for (const IdentifiedTap* const tap : channels) {
      all.push_back(*tap->sinusoid);
    }
  }
  std::ranges::sort(all, {}, &analysis::FittedSinusoid::frequency_hz);
  std::vector<double> means_hz;
  double sum_hz = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    sum_hz += all[i].frequency_hz;
    ++count;
    if (i + 1 == all.size() || is_apart(all[i], all[i + 1])) {
      means_hz.push_back(std::exchange(sum_hz, 0.0) / std::exchange(count, 0));
    }
  }
  return means_hz;
}
}  // namespace

std::string why_no_sinusoid(const TapIdentification& found) {
  std::vector<double> frequencies_hz = different_frequencies(fits_of(found));
  if (frequencies_hz.empty()) {
    return fmt::format(
        "no tap that was struck once and is not clipped is mostly one decaying sinusoid (it would "
        "have to explain {:.0f} % of its energy)",
        100.0 * min_explained_by_sinusoid);
  }
  if (frequencies_hz.size() == 1) {
    return "";
  }
  constexpr std::size_t most_named = 5;
  const bool are_many = frequencies_hz.size() > most_named;
  frequencies_hz.resize(std::min(frequencies_hz.size(), most_named));
  return fmt::format(
      "the decaying sinusoids of taps and sensors have not one frequency but {:.4g}{} Hz: no mean "
      "of them is given (different modes: --column takes one sensor, --band one mode)",
      fmt::join(frequencies_hz, ", "), are_many ? " ..." : "");
}

std::optional<SinusoidLaw> sinusoid_law(const TapIdentification& found,
                                        const std::optional<core::Finger>& finger) {
  const std::map<int, Fits> fits = fits_of(found);
  if (different_frequencies(fits).size() != 1) {
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

namespace {
constexpr double min_explained = 0.998;
constexpr double max_over_noise = 4.0;
constexpr double min_assurance = 0.5;
constexpr Eigen::Index few_values = 500;
constexpr Eigen::Index few_share = 4;  // samples to a value
}  // namespace

void remark_on_residuals(const std::vector<IdentifiedTap>& taps, TapRemarks& remarks) {
  for (const IdentifiedTap& tap : taps) {
    const analysis::DecayFit& fit = tap.modes.fit;
    if (!fit.has_converged) {
      remarks.add(tap.file, {tap.time_s, "the fit did not converge", {}});
    }
    const double over_noise = fit.noise / std::max(tap.noise_rms, 1e-300);
    if (fit.explained < min_explained && over_noise > max_over_noise) {
      remarks.add(tap.file,
                  {tap.time_s,
                   fmt::format("linear modes explain less than {:.1f} % of the energy, and what is "
                               "left is more than {:.0f} times the recording's noise (struck "
                               "twice, limited by the amplifier, or not linear?)",
                               100.0 * min_explained, max_over_noise),
                   fmt::format("{:.1f} %, {:.0f} times", 100.0 * fit.explained, over_noise)});
    }
  }
}

std::vector<std::string> remarks_on_scatter(const std::vector<analysis::RepeatedMode>& modes) {
  constexpr double improbable = 1e-3;
  std::vector<std::string> remarks;
  for (const analysis::RepeatedMode& mode : modes) {
    if (mode.standing == analysis::Standing::agreed && mode.scatter_p.value_or(1.0) < improbable) {
      remarks.push_back(fmt::format(
          "the mode at {:.6g} Hz scatters more over the taps than their noise explains (p = "
          "{:.1g}): "
          "two modes too close to be told apart, or a plate that is not linear; its intervals may "
          "hold neither",
          mode.frequency_hz.value, *mode.scatter_p));
    }
  }
  return remarks;
}

std::vector<std::string> remarks_on_resolution(const std::vector<IdentifiedTap>& taps) {
  std::vector<std::string> remarks;
  std::set<std::string> told;
  for (const IdentifiedTap& tap : taps) {
    const Eigen::VectorXd& samples = tap.decay.samples;
    const std::set<double> values{samples.begin(), samples.end()};
    const auto different = static_cast<Eigen::Index>(values.size());
    if (different < few_values && few_share * different < samples.size() &&
        told.insert(tap.file + tap.channel).second) {
      remarks.push_back(fmt::format(
          "{}: samples have only some {} different values: the intervals of damping ratios may be "
          "too narrow, above all of modes that ring for long (use more of the converter's range)",
          tap.file, different));
    }
  }
  return remarks;
}

std::vector<std::string> remarks_on_shapes(const analysis::ModelUpdate& update,
                                           const ModalFindings& identified) {
  std::vector<std::string> remarks;
  for (const analysis::MatchedMode& one : update.matched) {
    if (one.assurance && *one.assurance < min_assurance) {
      remarks.push_back(fmt::format(
          "the mode at {:.6g} Hz does not have the shape of the model's (MAC {:.2g}): are places, "
          "directions and impulses right?",
          identified.modes[identified.agreed[one.measured]].frequency_hz.value, *one.assurance));
    }
  }
  return remarks;
}
}  // namespace tapstudy::runner
