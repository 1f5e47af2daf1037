#include "analysis/modal/modes/neighbourhood_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "analysis/modal/decay/decay_fit.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double bins_around = 24.0;
constexpr double bandwidths_around = 5.0;
constexpr double most_damped = 0.01;          // else the part is too wide for others to be smooth
constexpr double max_neighbour_ratio = 0.05;  // what dies away sooner is as wide as the part
constexpr double contradicting_errors = 3.0;
constexpr double surer = 0.5;                // errors that chance does not make so much smaller
constexpr double largest_ratio_error = 0.2;  // of the ratio

Pole estimated_pole(const RepeatedMode& mode) {
  return {mode.frequency_hz.value, mode.damping_ratio.value};
}

Band part_around(const Pole& pole, double duration_s, double share, const Band& band) {
  const double bandwidth_hz = 2.0 * pole.damping_ratio * pole.frequency_hz;
  const double reach_hz =
      share * std::max(bins_around / duration_s, bandwidths_around * bandwidth_hz);
  return {std::max(band.low_hz, pole.frequency_hz - reach_hz),
          std::min(band.high_hz, pole.frequency_hz + reach_hz)};
}

// The mode as this tap shows it: the nearest of its own.
const TapMode* shown_by(const TapModes& tap, const Pole& pole) {
  const TapMode* nearest = nullptr;
  for (const TapMode& mode : tap.modes) {
    const double distance_hz = std::abs(mode.fitted.pole.frequency_hz - pole.frequency_hz);
    if (mode.standing == Standing::agreed &&
        distance_hz <= frequency_tolerance_hz(pole, 0.01, mode.fitted.frequency_error_hz) &&
        (nearest == nullptr ||
         distance_hz < std::abs(nearest->fitted.pole.frequency_hz - pole.frequency_hz))) {
      nearest = &mode;
    }
  }
  return nearest;
}

void add_neighbours(const TapModes& tap, const TapMode& itself, const Band& part,
                    SharingDecay& decay) {
  for (const TapMode& mode : tap.modes) {
    const Pole& pole = mode.fitted.pole;
    if (&mode == &itself || !part.holds(pole.frequency_hz)) {
      continue;
    }
    if (mode.standing == Standing::line) {
      decay.lines_hz.push_back(pole.frequency_hz);
    } else if (std::abs(pole.damping_ratio) < max_neighbour_ratio) {
      decay.own.push_back(pole);
    }
  }
  std::ranges::copy_if(tap.lines_hz, std::back_inserter(decay.lines_hz),
                       [&](double hz) { return part.holds(hz); });
}

// A mode by a part of the spectrum, with standard errors.
struct ModeOfPart {
  Pole pole;
  Pole errors;
  double degrees_of_freedom{};
};

// Unset where the part holds too little for a fit, or the fit is none of this mode.
std::optional<ModeOfPart> mode_of_part(const std::vector<FreeDecay>& decays, const Band& band,
                                       const std::vector<TapModes>& taps, const Pole& pole,
                                       double share) {
  std::vector<BandSpectrum> spectra;
  spectra.reserve(decays.size());  // sharing decays refer to them
  std::vector<SharingDecay> sharing;
  SharedFit fit;
  try {
    for (std::size_t i = 0; i < taps.size(); ++i) {
      if (const TapMode* const itself = shown_by(taps[i], pole)) {
        const Band part = part_around(pole, decays[i].duration_s(), share, band);
        spectra.push_back(band_spectrum(decays[i], part));
        sharing.push_back({&spectra.back(), {}, {}, taps[i].fit.noise});
        add_neighbours(taps[i], *itself, part, sharing.back());
      }
    }
    if (sharing.empty()) {
      return std::nullopt;
    }
    fit = fit_shared_poles(sharing, {pole});
  } catch (const core::InvalidInput&) {
    return std::nullopt;
  }
  if (!fit.decays.front().has_converged) {
    return std::nullopt;
  }
  const FittedMode& mode = fit.decays.front().modes.front();
  const bool is_this_mode =
      std::isfinite(mode.frequency_error_hz) &&
      mode.ratio_error < largest_ratio_error * mode.pole.damping_ratio &&
      std::abs(mode.pole.frequency_hz - pole.frequency_hz) <= frequency_tolerance_hz(pole, 0.01);
  return is_this_mode
             ? std::optional{ModeOfPart{
                   mode.pole, {mode.frequency_error_hz, mode.ratio_error}, fit.degrees_of_freedom}}
             : std::nullopt;
}

// What half of the part says otherwise is an error of what is not as smooth as that.
std::optional<ModeOfPart> mode_of_neighbourhood(const std::vector<FreeDecay>& decays,
                                                const Band& band, const std::vector<TapModes>& taps,
                                                const Pole& pole) {
  std::optional<ModeOfPart> whole = mode_of_part(decays, band, taps, pole, 1.0);
  const std::optional<ModeOfPart> half = mode_of_part(decays, band, taps, pole, 0.5);
  if (!whole || !half) {
    return std::nullopt;
  }
  whole->errors.frequency_hz =
      std::hypot(whole->errors.frequency_hz, half->pole.frequency_hz - whole->pole.frequency_hz);
  whole->errors.damping_ratio =
      std::hypot(whole->errors.damping_ratio, half->pole.damping_ratio - whole->pole.damping_ratio);
  return whole;
}

bool is_better(double value, double error, const Estimate& before) {
  const double larger_error = std::max(error, before.standard_error);
  return error < surer * before.standard_error ||
         std::abs(value - before.value) > contradicting_errors * larger_error;
}
}  // namespace

void fit_neighbourhoods(const std::vector<FreeDecay>& decays, const Band& band,
                        const std::vector<TapModes>& taps, std::vector<RepeatedMode>& modes) {
  for (RepeatedMode& mode : modes) {
    if (mode.standing != Standing::agreed || mode.at_tap ||
        mode.damping_ratio.value > most_damped) {
      continue;
    }
    const auto alone = mode_of_neighbourhood(decays, band, taps, estimated_pole(mode));
    if (alone &&
        (is_better(alone->pole.damping_ratio, alone->errors.damping_ratio, mode.damping_ratio) ||
         is_better(alone->pole.frequency_hz, alone->errors.frequency_hz, mode.frequency_hz))) {
      mode.degrees_of_freedom = alone->degrees_of_freedom;
      mode.frequency_hz =
          t_estimate(alone->pole.frequency_hz, alone->errors.frequency_hz, mode.degrees_of_freedom);
      mode.damping_ratio = t_estimate(alone->pole.damping_ratio, alone->errors.damping_ratio,
                                      mode.degrees_of_freedom);
    }
  }
}
}  // namespace tapstudy::analysis
