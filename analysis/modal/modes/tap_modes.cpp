#include "analysis/modal/modes/tap_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "analysis/modal/decay/decay_model.hpp"
#include "analysis/modal/decay/pole_estimation.hpp"
#include "analysis/modal/modes/mode_kinds.hpp"
#include "analysis/modal/modes/steady_tone.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double max_ratio = 0.7;
// The fall of a tone within the tap, in nepers. Below steady_fall it is steady or drifts, and below
// the second limit hum at a harmonic of the mains, unless nothing is there at rest; the fall must
// be significant.
constexpr double steady_fall = 0.15;
constexpr double plain_fall = 0.5;
constexpr double min_decay_z = 2.0;
constexpr double min_slow_decay_z = 4.0;
constexpr double rough_chi_squared = 0.1;  // a step's, below which a fit shows what is weak
constexpr int rough_steps = 8;
constexpr double neighbourhood = 0.1;  // of the frequency
constexpr double same_line = 0.01;
constexpr int further_pairs = 4;
constexpr double mains_tolerance = 0.004;
constexpr double highest_harmonic = 25.0;  // every frequency is near a multiple above

struct Candidate {
  Pole pole;
  int stable_orders{};
  std::optional<Pole> by_rational_fit;
};

bool agree(const FittedMode& fitted, const Pole& other) {
  const Pole& pole = fitted.pole;
  return std::abs(other.frequency_hz - pole.frequency_hz) <=
             frequency_tolerance_hz(pole, 0.01, fitted.frequency_error_hz) &&
         std::abs(other.damping_ratio - pole.damping_ratio) <=
             std::max({0.25 * std::abs(pole.damping_ratio), 0.003, 4.0 * fitted.ratio_error});
}

// Whether it has many times the energy of all that was recorded: two poles that nothing tells apart
// may get any amplitudes, if these cancel each other.
bool is_cancelled(const FittedMode& mode, const BandSpectrum& spectrum) {
  constexpr double most_energy = 100.0;  // of the recorded
  const double duration_s = static_cast<double>(spectrum.length) / spectrum.rate_hz;
  const double falls =
      2.0 * mode.pole.damping_ratio * 2.0 * std::numbers::pi * mode.pole.frequency_hz * duration_s;
  const double share = std::abs(falls) > 1e-6 ? -std::expm1(-falls) / falls : 1.0;
  const double recorded =
      2.0 * spectrum.values.squaredNorm() / static_cast<double>(spectrum.length);
  return 0.5 * mode.amplitude * mode.amplitude * static_cast<double>(spectrum.length) * share >
         most_energy * recorded;
}

// The modes that drop out: those that are not significant or left the band. Of neighbours only the
// weakest: two poles on one mode make each other insignificant.
std::vector<std::size_t> insignificant(const std::vector<FittedMode>& modes,
                                       const BandSpectrum& spectrum, const Band& band) {
  std::vector<std::pair<double, std::size_t>> weak;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const FittedMode& mode = modes[i];
    const bool is_possible = band.holds(mode.pole.frequency_hz) &&
                             std::abs(mode.pole.damping_ratio) < max_ratio &&
                             std::isfinite(mode.significance) && !is_cancelled(mode, spectrum);
    if (!is_possible || mode.significance < min_significance) {
      weak.emplace_back(is_possible ? mode.significance : 0.0, i);
    }
  }
  std::ranges::sort(weak);
  std::vector<std::size_t> dropped;
  for (const auto& [significance, i] : weak) {
    const double frequency_hz = modes[i].pole.frequency_hz;
    if (std::ranges::none_of(dropped, [&, frequency_hz](std::size_t other) {
          return std::abs(modes[other].pole.frequency_hz / frequency_hz - 1.0) < neighbourhood;
        })) {
      dropped.push_back(i);
    }
  }
  return dropped;
}

bool is_near(double frequency_hz, double line_hz) {
  return std::abs(frequency_hz / line_hz - 1.0) < same_line;
}

// A pole on a line that is in the fit already, and no mode that decays there.
bool is_at_line(const Pole& pole, double duration_s, const std::vector<double>& lines_hz) {
  const double fall = 2.0 * std::numbers::pi * pole.frequency_hz * pole.damping_ratio * duration_s;
  return std::abs(pole.damping_ratio) < same_line && fall < plain_fall &&
         is_among_lines(pole.frequency_hz, lines_hz);
}

std::vector<Pole> poles_of(const std::vector<Candidate>& candidates) {
  std::vector<Pole> poles;
  for (const Candidate& one : candidates) {
    poles.push_back(one.pole);
  }
  return poles;
}

// Without those to drop; the others as they were fitted.
std::vector<Candidate> kept_of(const std::vector<Candidate>& candidates,
                               const std::vector<std::size_t>& drop, const DecayFit& fit,
                               const Band& band) {
  std::vector<Candidate> kept;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (std::ranges::find(drop, i) != drop.end()) {
      continue;
    }
    kept.push_back(candidates[i]);
    const Pole& moved = fit.modes[i].pole;
    if (band.holds(moved.frequency_hz) && std::abs(moved.damping_ratio) < max_ratio) {
      kept.back().pole = moved;  // one that went astray starts again where it was found
    }
  }
  return kept;
}

// Fits, drops what is weak, and again, until all are significant. What is weak shows long before a
// fit has settled to the last digit.
DecayFit fit_significant(const BandSpectrum& spectrum, const Band& band,
                         const std::vector<double>& lines_hz, std::vector<Candidate>& candidates) {
  const Settling rough{rough_chi_squared / static_cast<double>(2 * spectrum.values.size()),
                       rough_steps};
  bool is_rough = true;
  for (;;) {
    DecayFit fit =
        fit_decay(spectrum, poles_of(candidates), lines_hz, is_rough ? rough : settled_fit);
    const std::vector<std::size_t> drop = insignificant(fit.modes, spectrum, band);
    if (drop.empty() && !is_rough) {
      return fit;
    }
    is_rough = !drop.empty();
    candidates = kept_of(candidates, drop, fit, band);
  }
}

// Each pole of the rational fit goes to the nearest mode with which it agrees, one to each.
void match_rational_fit(const DecayFit& fit, const std::vector<Pole>& rational,
                        std::vector<Candidate>& candidates, std::vector<Pole>& unmatched) {
  for (const Pole& pole : rational) {
    std::size_t best = candidates.size();
    double least = 0.0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const double distance = std::abs(fit.modes[i].pole.frequency_hz - pole.frequency_hz);
      if (!candidates[i].by_rational_fit && agree(fit.modes[i], pole) &&
          (best == candidates.size() || distance < least)) {
        best = i;
        least = distance;
      }
    }
    if (best < candidates.size()) {
      candidates[best].by_rational_fit = pole;
    } else if (pole.damping_ratio < max_ratio) {
      unmatched.push_back(pole);
    }
  }
}

// "50 Hz hum, harmonic 3", or empty. In grids of 50 and 60 Hz.
std::string hum_at(const FittedMode& mode) {
  for (const double mains_hz : std::array{50.0, 60.0}) {
    const double harmonic = std::round(mode.pole.frequency_hz / mains_hz);
    const double distance = std::abs(mode.pole.frequency_hz - harmonic * mains_hz);
    if (harmonic >= 1.0 && harmonic <= highest_harmonic &&
        distance <=
            std::max(mains_tolerance * mode.pole.frequency_hz, 4.0 * mode.frequency_error_hz)) {
      return harmonic == 1.0
                 ? fmt::format("{:.0f} Hz hum of the mains", mains_hz)
                 : fmt::format("hum of the mains, {:.0f} times {:.0f} Hz", harmonic, mains_hz);
    }
  }
  return {};
}

double decay_per_s(const FittedMode& mode) {
  return mode.pole.damping_ratio * 2.0 * std::numbers::pi * mode.pole.frequency_hz;
}

// Of hum, which is there before the tap as well. The amplitude at rest is of a whole neighbourhood.
bool is_silent_at_rest(const FittedMode& mode, double duration_s, const FreeDecay& rest) {
  constexpr double share_of_hum = 0.3;
  const double least = mode.amplitude * std::exp(-decay_per_s(mode) * duration_s);
  const double hz = mode.pole.frequency_hz;
  return rest.samples.size() > 0 && rest.duration_s() >= shortest_stretch_s &&
         rest.duration_s() * hz >= min_periods && amplitude_at(hz, rest) < share_of_hum * least;
}

bool is_line(const FittedMode& mode, double duration_s, const FreeDecay& rest) {
  const double fall = decay_per_s(mode) * duration_s;
  const double z = decay_per_s(mode) / mode.decay_error_per_s;
  if (fall >= plain_fall) {
    return z < min_decay_z;
  }
  const bool may_be_steady = fall < steady_fall || !hum_at(mode).empty();
  return z < min_slow_decay_z || (may_be_steady && !is_silent_at_rest(mode, duration_s, rest));
}

bool grows(const FittedMode& mode, double duration_s) {
  return decay_per_s(mode) * duration_s <= -plain_fall &&
         decay_per_s(mode) < -min_slow_decay_z * mode.decay_error_per_s;
}

TapMode judged(const FittedMode& fitted, const Candidate& candidate, double duration_s,
               const FreeDecay& rest) {
  TapMode mode{fitted, Standing::agreed, {}, candidate.by_rational_fit, candidate.stable_orders};
  if (grows(fitted, duration_s)) {
    mode.standing = Standing::doubtful;
    mode.why = "grows: no free decay";
  } else if (is_line(fitted, duration_s, rest)) {
    mode.standing = Standing::line;
    mode.why = is_silent_at_rest(fitted, duration_s, rest) ? "" : hum_at(fitted);
    if (mode.why.empty()) {
      mode.why = "hardly decays within the tap: a steady tone, or a mode that takes --longest";
    }
  } else if (candidate.stable_orders == 0) {
    mode.standing = Standing::doubtful;
    mode.why = "not stable over the orders of the matrix pencil";
  } else if (!candidate.by_rational_fit) {
    mode.standing = Standing::doubtful;
    mode.why = "not found by the rational fit";
  }
  return mode;
}
}  // namespace

const char* name(Standing standing) {
  switch (standing) {
    case Standing::agreed:
      return "agreed";
    case Standing::doubtful:
      return "doubtful";
    case Standing::line:
      return "line";
    case Standing::background:
      return "background";
    case Standing::combination:
      return "combination";
  }
  return "";
}

// A mode has four unknowns, a line two; each value of the spectrum gives two numbers.
std::size_t max_mode_count(const BandSpectrum& spectrum, const std::vector<double>& lines_hz) {
  const Eigen::Index values = spectrum.values.size();
  const auto beside_lines = (2 * values - 5 - 2 * std::ssize(lines_hz)) / 4;
  return static_cast<std::size_t>(std::clamp<Eigen::Index>(beside_lines, 0, (values - 4) / 3));
}

namespace {
Band somewhat_wider(const Band& band, double rate_hz) {
  constexpr double of_width = 0.4;
  const double margin_hz = of_width * (band.high_hz - band.low_hz);
  return {std::max(0.8 * band.low_hz, band.low_hz - margin_hz),
          std::min({1.25 * band.high_hz, band.high_hz + margin_hz, 0.47 * rate_hz})};
}

void judge(const std::vector<Candidate>& candidates, const Band& band, double duration_s,
           const FreeDecay& rest, TapModes& result) {
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const FittedMode& fitted = result.fit.modes[i];
    if (band.holds(fitted.pole.frequency_hz)) {
      result.modes.push_back(judged(fitted, candidates[i], duration_s, rest));
    }
  }
  std::ranges::sort(result.modes, {},
                    [](const TapMode& mode) { return mode.fitted.pole.frequency_hz; });
}
}  // namespace

TapModes identify_modes(const FreeDecay& decay, const Band& band, const FreeDecay& rest) {
  const Band wide = somewhat_wider(band, decay.rate_hz);
  TapModes result;
  result.pencil = matrix_pencil(decay, wide, max_model_order);
  result.spectrum = band_spectrum(decay, wide);
  const std::size_t room = max_mode_count(result.spectrum, {});
  std::vector<StablePole> stable = stable_poles(result.pencil.orders);
  std::ranges::stable_sort(stable, std::ranges::greater{}, &StablePole::orders);
  stable.resize(std::min(stable.size(), room));
  std::vector<Candidate> candidates;
  for (const StablePole& one : stable) {
    candidates.push_back({one.pole, one.orders, std::nullopt});
  }
  result.fit = fit_significant(result.spectrum, wide, {}, candidates);
  const int pairs =
      std::min(static_cast<int>(candidates.size()) + further_pairs, static_cast<int>(room));
  std::vector<Pole> unmatched;
  match_rational_fit(result.fit, vector_fitting(result.spectrum, pairs), candidates, unmatched);
  if (!unmatched.empty() && candidates.size() + unmatched.size() <= room) {
    for (const Pole& pole : unmatched) {
      candidates.push_back({pole, 0, pole});
    }
    result.fit = fit_significant(result.spectrum, wide, {}, candidates);
  }
  judge(candidates, band, decay.duration_s(), rest, result);
  return result;
}

TapModes with_lines(const TapModes& before, const FreeDecay& decay, const Band& band,
                    const std::vector<double>& lines_hz, const FreeDecay& rest) {
  TapModes result = before;
  const Band wide = somewhat_wider(band, decay.rate_hz);
  result.spectrum = band_spectrum(decay, wide);
  result.lines_hz = lines_hz;
  result.modes.clear();
  std::vector<Candidate> candidates;
  for (const FittedMode& fitted : before.fit.modes) {
    const auto known = std::ranges::find_if(before.modes, [&](const TapMode& mode) {
      return mode.fitted.pole.frequency_hz == fitted.pole.frequency_hz;
    });
    if (is_at_line(fitted.pole, decay.duration_s(), lines_hz)) {
      continue;
    }
    candidates.push_back({fitted.pole, 0, std::nullopt});
    if (known != before.modes.end()) {
      candidates.back() = {fitted.pole, known->stable_orders, known->by_rational_fit};
    }
  }
  if (candidates.size() > max_mode_count(before.spectrum, lines_hz)) {
    throw core::InvalidInput{"a decay is too short for so many modes and lines"};
  }
  result.fit = fit_significant(result.spectrum, wide, lines_hz, candidates);
  judge(candidates, band, decay.duration_s(), rest, result);
  return result;
}

FreeDecay without_modes(FreeDecay decay, const std::vector<TapMode>& modes) {
  for (const TapMode& mode : modes) {
    const FittedMode& fitted = mode.fitted;
    if (fitted.pole.damping_ratio < 0.0) {
      continue;  // no free decay
    }
    const std::complex<double> log_z = log_of(fitted.pole, decay.rate_hz);
    for (Eigen::Index i = 0; i < decay.samples.size(); ++i) {
      const auto n = static_cast<double>(i);
      decay.samples[i] -= fitted.amplitude * std::exp(log_z.real() * n) *
                          std::cos(log_z.imag() * n + fitted.phase_rad);
    }
  }
  return decay;
}

bool is_among_lines(double frequency_hz, const std::vector<double>& lines_hz) {
  return std::ranges::any_of(lines_hz,
                             [&](double line_hz) { return is_near(frequency_hz, line_hz); });
}

std::vector<double> missed_lines(const TapModes& tap, const std::vector<TapModes>& taps) {
  std::vector<double> missed;
  const auto frequency_of = [](const TapMode& mode) { return mode.fitted.pole.frequency_hz; };
  for (const TapModes& other : taps) {
    for (const TapMode& mode : other.modes) {
      const double line_hz = frequency_of(mode);
      const auto is_it = [&](double frequency_hz) { return is_near(frequency_hz, line_hz); };
      if (mode.standing == Standing::line && std::ranges::none_of(missed, is_it) &&
          std::ranges::none_of(tap.modes, is_it, frequency_of)) {
        missed.push_back(line_hz);
      }
    }
  }
  return missed;
}

namespace {
void add_part(const TapModes& part, TapModes& all) {
  all.modes.insert(all.modes.end(), part.modes.begin(), part.modes.end());
  all.lines_hz.insert(all.lines_hz.end(), part.lines_hz.begin(), part.lines_hz.end());
  for (const TapMode& mode : part.modes) {
    all.fit.modes.push_back(mode.fitted);
  }
  all.fit.has_converged = all.fit.has_converged && part.fit.has_converged;
  all.pencil.significant_order += part.pencil.significant_order;
  for (std::size_t i = 0; i < part.pencil.orders.size(); ++i) {
    if (i == all.pencil.orders.size()) {
      all.pencil.orders.push_back({part.pencil.orders[i].order, {}});
    }
    std::vector<Pole>& poles = all.pencil.orders[i].poles;
    poles.insert(poles.end(), part.pencil.orders[i].poles.begin(),
                 part.pencil.orders[i].poles.end());
  }
}
}  // namespace

TapModes joined(const FreeDecay& decay, const Band& band, const std::vector<TapModes>& parts) {
  if (parts.size() == 1) {
    return parts.front();
  }
  TapModes all;
  all.fit.has_converged = true;
  for (const TapModes& part : parts) {
    add_part(part, all);
  }
  all.spectrum = band_spectrum(decay, band);
  std::vector<Pole> poles;
  for (const FittedMode& fitted : all.fit.modes) {
    poles.push_back(fitted.pole);
  }
  const DecayModel model{all.spectrum, std::ssize(poles), all.lines_hz};
  set_residual(model, model.at(model.logs_of(poles)), all.fit);
  return all;
}
}  // namespace tapstudy::analysis
