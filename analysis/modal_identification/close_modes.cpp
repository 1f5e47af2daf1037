#include "analysis/modal_identification/close_modes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "analysis/modal_identification/neighbouring_modes.hpp"
#include "analysis/statistics/distributions.hpp"
namespace tapstudy::analysis {
namespace {
constexpr int highest_order = 60;
const char* const by_all_taps = "told from its neighbour by all taps together";

double frequency_of(const FittedMode& mode) {
  return mode.pole.frequency_hz;
}

bool is_line(const TapModes& tap, const FittedMode& fitted) {
  return std::ranges::any_of(tap.modes, [&](const TapMode& mode) {
    return mode.standing == Standing::line && frequency_of(mode.fitted) == frequency_of(fitted);
  });
}

// What one tap shows beside the neighbours. Empty: a tap too short for so many modes.
std::vector<SharingDecay> sharing(const std::vector<TapModes>& taps, const Neighbours& neighbours,
                                  std::size_t shared) {
  std::vector<SharingDecay> decays;
  for (const TapModes& tap : taps) {
    SharingDecay decay{&tap.spectrum, {}, tap.lines_hz, std::max(tap.fit.noise, 1e-300)};
    for (const FittedMode& fitted : tap.fit.modes) {
      if (!neighbours.range.holds(frequency_of(fitted)) || is_line(tap, fitted)) {
        decay.own.push_back(fitted.pole);
      }
    }
    if (decay.own.size() + shared > most_modes(tap.spectrum, tap.lines_hz)) {
      return {};
    }
    decays.push_back(std::move(decay));
  }
  return decays;
}

// Schwarz's criterion, -2 ln likelihood + unknowns ln values, of white noise of unknown variance in
// each decay.
struct Criterion {
  double deviance{};
  double unknowns{};  // of the neighbours alone
  double values{};

  void add(const DecayFit& fit, std::size_t modes) {
    deviance += fit.values * std::log(std::max(fit.sum_of_squares, 1e-300) / fit.values);
    unknowns += 2.0 * static_cast<double>(modes);
    values += fit.values;
  }
  double value() const { return deviance + unknowns * std::log(values); }
};

Criterion criterion_of(const SharedFit& fit, std::size_t shared) {
  Criterion criterion{0.0, 2.0 * static_cast<double>(shared), 0.0};
  for (const DecayFit& decay : fit.decays) {
    criterion.add(decay, shared);
  }
  return criterion;
}

std::vector<Pole> own_poles(const TapModes& tap, const Neighbours& neighbours) {
  std::vector<Pole> poles;
  for (const FittedMode& fitted : tap.fit.modes) {
    if (neighbours.range.holds(frequency_of(fitted)) && !is_line(tap, fitted)) {
      poles.push_back(fitted.pole);
    }
  }
  return poles;
}

// With poles of each impact's own, those that one of its channels shows; its channels share them.
Criterion criterion_of_impacts(const std::vector<TapModes>& taps, const std::vector<int>& impacts,
                               const Neighbours& neighbours) {
  std::map<int, std::vector<TapModes>> by_impact;
  for (std::size_t i = 0; i < taps.size(); ++i) {
    by_impact[impacts[i]].push_back(taps[i]);
  }
  Criterion all;
  for (const auto& [impact, channels] : by_impact) {
    std::vector<std::vector<Pole>> poles;
    for (const TapModes& channel : channels) {
      poles.push_back(own_poles(channel, neighbours));
    }
    const std::vector<Pole>& most = *std::ranges::max_element(poles, {}, &std::vector<Pole>::size);
    const std::vector<SharingDecay> decays = sharing(channels, neighbours, most.size());
    const Criterion one = criterion_of(fit_shared_poles(decays, most), most.size());
    all.deviance += one.deviance;
    all.unknowns += one.unknowns;
    all.values += one.values;
  }
  return all;
}

std::vector<Pole> shared_poles(const SharedFit& fit, std::size_t shared) {
  std::vector<Pole> poles;
  for (std::size_t k = 0; k < shared; ++k) {
    poles.push_back(fit.decays.front().modes[k].pole);
  }
  return poles;
}

// For each impact the pseudo-value of each shared pole, n all - (n - 1) without it.
std::vector<std::vector<Pole>> pseudo_values(const std::vector<SharingDecay>& decays,
                                             const std::vector<int>& impacts,
                                             const std::vector<Pole>& of_all) {
  const std::set<int> different{impacts.begin(), impacts.end()};
  const auto count = static_cast<double>(different.size());
  std::vector<std::vector<Pole>> values;
  for (const int without : different) {
    std::vector<SharingDecay> others;
    for (std::size_t i = 0; i < decays.size(); ++i) {
      if (impacts[i] != without) {
        others.push_back(decays[i]);
      }
    }
    std::vector<Pole> poles = of_all;
    if (!others.empty()) {
      const std::vector<Pole> of_others =
          shared_poles(fit_shared_poles(others, of_all), of_all.size());
      for (std::size_t k = 0; k < poles.size(); ++k) {
        poles[k].frequency_hz +=
            (count - 1.0) * (poles[k].frequency_hz - of_others[k].frequency_hz);
        poles[k].damping_ratio +=
            (count - 1.0) * (poles[k].damping_ratio - of_others[k].damping_ratio);
      }
    }
    values.push_back(std::move(poles));
  }
  return values;
}

// Student's over impacts, and not narrower than what the noise alone gives: where few of the
// impacts tell the modes apart, their pseudo-values are not normal.
Estimate estimate(const std::vector<double>& values, double error, double degrees_of_freedom) {
  const std::vector<double> errors(values.size(),
                                   error * std::sqrt(static_cast<double>(values.size())));
  Estimate estimate = estimate_over_taps(values, errors, degrees_of_freedom);
  const double half = t_quantile(0.975, degrees_of_freedom) * error;
  estimate.interval.low = std::min(estimate.interval.low, estimate.value - half);
  estimate.interval.high = std::max(estimate.interval.high, estimate.value + half);
  return estimate;
}

RepeatedMode repeated(const std::vector<std::vector<Pole>>& values, std::size_t k,
                      const SharedFit& together) {
  const FittedMode& fitted = together.decays.front().modes[k];
  RepeatedMode mode;
  for (const std::vector<Pole>& poles : values) {
    mode.frequencies_hz.push_back(poles[k].frequency_hz);
    mode.ratios.push_back(poles[k].damping_ratio);
  }
  const double freedom = together.degrees_of_freedom;
  mode.frequency_hz = estimate(mode.frequencies_hz, fitted.frequency_error_hz, freedom);
  mode.damping_ratio = estimate(mode.ratios, fitted.ratio_error, freedom);
  mode.degrees_of_freedom = values.size() > 1 ? static_cast<double>(values.size()) - 1.0 : freedom;
  mode.standing = Standing::agreed;
  mode.why = by_all_taps;
  mode.taps = static_cast<int>(together.decays.size());
  mode.agreed = mode.taps;
  return mode;
}

void replace_in_tap(const Neighbours& neighbours, const DecayFit& fit, std::size_t shared,
                    TapModes& tap) {
  std::erase_if(tap.modes, [&](const TapMode& mode) {
    return mode.standing != Standing::line && neighbours.range.holds(frequency_of(mode.fitted));
  });
  for (std::size_t k = 0; k < shared; ++k) {
    tap.modes.push_back(
        {fit.modes[k], Standing::agreed, by_all_taps, std::nullopt, min_stable_orders});
  }
  std::ranges::sort(tap.modes, {}, [](const TapMode& mode) { return frequency_of(mode.fitted); });
  tap.fit = fit;
}

// Nothing is changed unless they are told apart.
void tell_apart(const Neighbours& neighbours, const std::vector<Pole>& poles,
                const std::vector<int>& impacts, ModesOfTaps& found) {
  const std::vector<SharingDecay> decays = sharing(found.taps, neighbours, poles.size());
  if (decays.empty()) {
    return;
  }
  const SharedFit together = fit_shared_poles(decays, poles);
  const std::vector<Pole> fitted = shared_poles(together, poles.size());
  const bool are_inside =
      std::ranges::all_of(fitted, [&](const Pole& pole) { return neighbours.may_hold(pole); });
  if (!are_inside || criterion_of(together, poles.size()).value() >=
                         criterion_of_impacts(found.taps, impacts, neighbours).value()) {
    return;
  }
  std::erase_if(found.modes, [&](const RepeatedMode& mode) {
    return mode.standing != Standing::line && neighbours.range.holds(mode.frequency_hz.value);
  });
  const std::vector<std::vector<Pole>> values = pseudo_values(decays, impacts, fitted);
  for (std::size_t k = 0; k < poles.size(); ++k) {
    found.modes.push_back(repeated(values, k, together));
  }
  for (std::size_t i = 0; i < found.taps.size(); ++i) {
    replace_in_tap(neighbours, together.decays[i], poles.size(), found.taps[i]);
  }
}
}  // namespace

ModesOfTaps tell_close_modes_apart(const std::vector<FreeDecay>& decays,
                                   const std::vector<int>& impacts, const Band& band,
                                   const ModesOfTaps& found) {
  ModesOfTaps result = found;
  const bool is_of_one_rate = std::ranges::all_of(
      decays, [&](const FreeDecay& decay) { return decay.rate_hz == decays.front().rate_hz; });
  if (!is_of_one_rate) {
    return result;
  }
  std::vector<double> noise;
  for (const TapModes& tap : found.taps) {
    noise.push_back(std::max(tap.fit.noise, 1e-300));
  }
  const MatrixPencil pencil = matrix_pencil(decays, noise, band, highest_order);
  for (const Neighbours& neighbours : neighbours_among(found.modes)) {
    const std::vector<Pole> poles = poles_by_all(pencil, neighbours);
    if (!poles.empty()) {
      tell_apart(neighbours, poles, impacts, result);
    }
  }
  std::ranges::sort(result.modes, {},
                    [](const RepeatedMode& mode) { return mode.frequency_hz.value; });
  return result;
}
}  // namespace tapstudy::analysis
