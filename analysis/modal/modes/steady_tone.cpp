#include "analysis/modal/modes/steady_tone.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/statistics/quantiles.hpp"
#include "analysis/statistics/resampling/replicates.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double fewest_periods = 10.0;
constexpr double tone_over_error = 8.0;
constexpr double most_tone_fall = 0.4;      // nepers
constexpr double least_fall_of_mode = 1.0;  // nepers: less of it, still ringing, looks steady
constexpr double bins_around_tone = 12.0;
constexpr double least_tone = 1e-3;     // of the mode
constexpr double shift_by_share = 4.0;  // of the mode's decay rate

// Whether anything is worth a fit: a tone that the fit will know so well is far above the median.
bool stands_out(const FreeDecay& stretch, const Band& near, double near_hz, double reach_hz) {
  constexpr double over_median = 4.0;
  const BandSpectrum spectrum = band_spectrum(stretch, near);
  std::vector<double> all;
  double within = 0.0;
  for (Eigen::Index k = 0; k < spectrum.values.size(); ++k) {
    const double hz = spectrum.rad_per_sample[k] * spectrum.rate_hz / (2.0 * std::numbers::pi);
    all.push_back(std::abs(spectrum.values[k]));
    const double bin_hz = spectrum.rate_hz / static_cast<double>(spectrum.length);
    within = std::abs(hz - near_hz) <= reach_hz + bin_hz ? std::max(within, all.back()) : within;
  }
  return within > over_median * quantile(all, 0.5);
}

bool is_known_steady(const FittedMode& fitted, double duration_s) {
  const double fall =
      2.0 * std::numbers::pi * fitted.pole.frequency_hz * fitted.pole.damping_ratio * duration_s;
  return std::abs(fall) + 2.0 * fitted.decay_error_per_s * duration_s < most_tone_fall &&
         fitted.amplitude > tone_over_error * fitted.amplitude_error;
}

// In the middle of the stretch amplitude and phase hardly depend on frequency and damping.
SteadyTone tone_of(const FittedMode& fitted, double duration_s) {
  const double omega = 2.0 * std::numbers::pi * fitted.pole.frequency_hz;
  const double middle_s = 0.5 * duration_s;
  return {fitted.pole.frequency_hz,
          fitted.amplitude * std::exp(-fitted.pole.damping_ratio * omega * middle_s),
          std::remainder(fitted.phase_rad + omega * middle_s, 2.0 * std::numbers::pi),
          middle_s,
          fitted.frequency_error_hz,
          fitted.amplitude_error};
}
}  // namespace

double SteadyTone::error_at(double t_s) const {
  const double turned_rad = 2.0 * std::numbers::pi * frequency_error_hz * (t_s - middle_s);
  return std::hypot(std::numbers::sqrt2 * amplitude_error, amplitude * turned_rad);
}

namespace {
Band band_near(const FreeDecay& stretch, double near_hz, double reach_hz) {
  const double half_hz = std::max(2.0 * reach_hz, bins_around_tone / stretch.duration_s());
  return {std::max(0.2 * near_hz, near_hz - half_hz),
          std::min(0.47 * stretch.rate_hz, near_hz + half_hz)};
}

bool is_long_enough(const FreeDecay& stretch, double near_hz) {
  return stretch.duration_s() >= shortest_stretch_s &&
         stretch.duration_s() * near_hz >= fewest_periods;
}
}  // namespace

std::optional<SteadyTone> steady_tone(const FreeDecay& stretch, double near_hz, double reach_hz,
                                      double struck_s) {
  if (!is_long_enough(stretch, near_hz)) {
    return std::nullopt;
  }
  const Band near = band_near(stretch, near_hz, reach_hz);
  const FreeDecay centred = about_mean(stretch);
  std::optional<SteadyTone> strongest;
  try {
    if (!stands_out(centred, near, near_hz, reach_hz)) {
      return std::nullopt;
    }
    for (const TapMode& mode : identify_modes(centred, near).modes) {
      const FittedMode& fitted = mode.fitted;
      if (std::abs(fitted.pole.frequency_hz - near_hz) <= reach_hz &&
          is_known_steady(fitted, struck_s + stretch.duration_s()) &&
          (!strongest || fitted.amplitude > strongest->amplitude)) {
        strongest = tone_of(fitted, stretch.duration_s());
      }
    }
  } catch (const core::InvalidInput&) {
    return std::nullopt;  // too short for the band
  }
  return strongest;
}

void take_tone(const SteadyTone& tone, double begins_s, FreeDecay& decay) {
  const double omega = 2.0 * std::numbers::pi * tone.frequency_hz;
  for (Eigen::Index n = 0; n < decay.samples.size(); ++n) {
    const double t_s = begins_s + static_cast<double>(n) / decay.rate_hz;
    decay.samples[n] -= tone.amplitude * std::cos(omega * (t_s - tone.middle_s) + tone.phase_rad);
  }
}

double tone_reach_hz(const RepeatedMode& mode, double decay_s) {
  const double bandwidth_hz = 2.0 * std::abs(mode.damping_ratio.value) * mode.frequency_hz.value;
  return std::max(bandwidth_hz, 0.5 / decay_s);
}

namespace {
// Whether what is left of a mode would not look steady there.
bool can_tell(const RepeatedMode& mode, const QuietStretch& stretch) {
  const double decay_per_s =
      2.0 * std::numbers::pi * mode.frequency_hz.value * std::abs(mode.damping_ratio.value);
  const double duration_s = stretch.samples.duration_s();
  return duration_s >= shortest_stretch_s && decay_per_s * duration_s >= least_fall_of_mode;
}
}  // namespace

std::optional<ToneOfTaps> tone_near(const RepeatedMode& mode,
                                    const std::vector<QuietStretch>& stretches, double reach_hz) {
  ToneOfTaps tone;
  std::vector<double> frequencies_hz;
  std::vector<double> amplitudes;
  tone.of_taps.resize(stretches.size());
  parallel_for(stretches.size(), 0, [&](std::size_t i) {
    if (can_tell(mode, stretches[i])) {
      tone.of_taps[i] = steady_tone(stretches[i].samples, mode.frequency_hz.value, reach_hz,
                                    stretches[i].struck_s);
    }
  });
  std::size_t telling = 0;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    telling += can_tell(mode, stretches[i]) ? 1 : 0;
    const auto& known = tone.of_taps[i];
    tone.errors.push_back(known ? known->error_at(stretches[i].decay_begins_s) : 0.0);
    if (known) {
      frequencies_hz.push_back(known->frequency_hz);
      amplitudes.push_back(known->amplitude);
    }
  }
  if (amplitudes.empty() || 2 * amplitudes.size() < telling) {
    return std::nullopt;
  }
  tone.frequency_hz = quantile(frequencies_hz, 0.5);
  tone.amplitude = quantile(amplitudes, 0.5);
  return tone.amplitude >= least_tone * mode.amplitude ? std::optional{tone} : std::nullopt;
}

namespace {
bool is_beside(const ToneOfTaps& tone, const RepeatedMode& mode, double decay_s) {
  return std::abs(tone.frequency_hz - mode.frequency_hz.value) <= tone_reach_hz(mode, decay_s);
}

// By the lines at its harmonics, two at least; unset if there are none.
std::optional<double> mains_hz(const std::vector<RepeatedMode>& modes) {
  constexpr double tolerance = 0.004;
  for (const double nominal_hz : {50.0, 60.0}) {
    std::vector<double> fundamentals_hz;
    for (const RepeatedMode& mode : modes) {
      const double harmonic = std::round(mode.frequency_hz.value / nominal_hz);
      const double fundamental_hz = mode.frequency_hz.value / std::max(1.0, harmonic);
      if (mode.standing == Standing::line &&
          std::abs(fundamental_hz / nominal_hz - 1.0) < tolerance) {
        fundamentals_hz.push_back(fundamental_hz);
      }
    }
    if (fundamentals_hz.size() >= 2) {
      return quantile(fundamentals_hz, 0.5);
    }
  }
  return std::nullopt;
}

bool shows_nothing(const RepeatedMode& mode, const QuietStretch& stretch, double reach_hz) {
  const double near_hz = mode.frequency_hz.value;
  if (!can_tell(mode, stretch) || !is_long_enough(stretch.samples, near_hz)) {
    return false;
  }
  try {
    return !stands_out(about_mean(stretch.samples), band_near(stretch.samples, near_hz, reach_hz),
                       near_hz, reach_hz);
  } catch (const core::InvalidInput&) {
    return false;
  }
}

// The harmonic of the mains next to a mode, if not half of the stretches show that there is none.
std::optional<ToneOfTaps> untold_hum(const RepeatedMode& mode, std::optional<double> mains,
                                     const std::vector<QuietStretch>& stretches, double reach_hz) {
  constexpr double most_distance_hz = 1.0;
  if (!mains) {
    return std::nullopt;
  }
  ToneOfTaps hum;
  hum.frequency_hz = *mains * std::max(1.0, std::round(mode.frequency_hz.value / *mains));
  hum.of_taps.resize(stretches.size());
  hum.errors.resize(stretches.size());
  const double distance_hz = std::abs(hum.frequency_hz - mode.frequency_hz.value);
  const auto nothing = std::ranges::count_if(stretches, [&](const QuietStretch& stretch) {
    return shows_nothing(mode, stretch, reach_hz);
  });
  return distance_hz <= std::min(reach_hz, most_distance_hz) && 2 * nothing < std::ssize(stretches)
             ? std::optional{hum}
             : std::nullopt;
}
}  // namespace

std::vector<ToneOfTaps> tones_in(const std::vector<RepeatedMode>& modes,
                                 const std::vector<QuietStretch>& stretches, double decay_s) {
  const std::optional<double> mains = mains_hz(modes);
  std::vector<ToneOfTaps> tones;
  for (const RepeatedMode& mode : modes) {
    const bool is_agreed = mode.standing == Standing::agreed;
    if ((!is_agreed && mode.standing != Standing::doubtful) || mode.damping_ratio.value <= 0.0 ||
        std::ranges::any_of(tones,
                            [&](const auto& one) { return is_beside(one, mode, decay_s); })) {
      continue;
    }
    const double reach_hz = tone_reach_hz(mode, decay_s);
    auto tone = tone_near(mode, stretches, reach_hz);
    if (!tone) {
      tone = untold_hum(mode, mains, stretches, reach_hz);
    }
    if (tone && (is_agreed || mode.amplitude > tone->amplitude)) {
      tones.push_back(std::move(*tone));
    }
  }
  return tones;
}

namespace {
void widen_by(double error, Estimate& estimate) {
  estimate.standard_error = std::hypot(estimate.standard_error, error);
  const auto widened = [&](Interval& interval) {
    interval.low = estimate.value - std::hypot(estimate.value - interval.low, 2.0 * error);
    interval.high = estimate.value + std::hypot(interval.high - estimate.value, 2.0 * error);
  };
  widened(estimate.interval);
  if (estimate.bootstrap) {
    widened(*estimate.bootstrap);
  }
}

void tell_of_tone(const ToneOfTaps& tone, RepeatedMode& mode) {
  double squares = 0.0;
  for (const double error : tone.errors) {
    squares += error * error;
  }
  const double size = std::max(mode.amplitude, 1e-300);
  const double shift = shift_by_share * std::abs(mode.damping_ratio.value) * std::sqrt(squares) /
                       static_cast<double>(tone.errors.size()) / size;
  widen_by(shift, mode.damping_ratio);
  widen_by(shift * mode.frequency_hz.value, mode.frequency_hz);
  mode.scatter_p.reset();  // what is left of the tone makes it scatter
  const auto known =
      std::ranges::count_if(tone.of_taps, [](const auto& of) { return of.has_value(); });
  const auto taps = std::ssize(tone.of_taps);
  mode.why += fmt::format(
      "{}a steady tone of {:.5g} Hz{} ", mode.why.empty() ? "" : "; ", tone.frequency_hz,
      tone.amplitude > 0.0
          ? fmt::format(", {:.0f} dB below it,", -20.0 * std::log10(tone.amplitude / size))
          : "");
  mode.why += known == taps
                  ? "was taken out of it"
                  : fmt::format(
                        "lies within its width and was fitted beside it in {} of {} taps: "
                        "its damping is less certain than its interval says",
                        taps - known, taps);
}
}  // namespace

void tell_of_tones(const std::vector<ToneOfTaps>& tones, double decay_s,
                   std::vector<RepeatedMode>& modes) {
  for (const ToneOfTaps& tone : tones) {
    for (RepeatedMode& mode : modes) {
      if (mode.standing == Standing::agreed && is_beside(tone, mode, decay_s)) {
        tell_of_tone(tone, mode);
      }
    }
  }
}
}  // namespace tapstudy::analysis
