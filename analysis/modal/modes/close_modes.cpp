#include "analysis/modal/modes/close_modes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "analysis/statistics/quantiles.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double max_ratio_factor = 5.0;

double median_of(const std::vector<std::vector<Pole>>& sets, std::size_t k, double Pole::*part) {
  std::vector<double> values;
  for (const std::vector<Pole>& poles : sets) {
    values.push_back(poles[k].*part);
  }
  return quantile(values, 0.5);
}
}  // namespace

bool CloseModes::may_hold(const Pole& pole) const {
  return range.holds(pole.frequency_hz) && pole.damping_ratio > least_ratio / max_ratio_factor &&
         pole.damping_ratio < greatest_ratio * max_ratio_factor;
}

std::vector<CloseModes> close_modes_among(const std::vector<RepeatedMode>& modes) {
  std::vector<CloseModes> all;
  for (const RepeatedMode& mode : modes) {
    const double ratio = mode.damping_ratio.value;
    if (mode.standing == Standing::line || ratio <= 0.0) {
      continue;
    }
    const std::size_t agreed = mode.standing == Standing::agreed ? 1 : 0;
    const double frequency_hz = mode.frequency_hz.value;
    const double bandwidth_hz = 2.0 * ratio * frequency_hz;
    const Band range{frequency_hz - bandwidth_hz, frequency_hz + bandwidth_hz};
    if (all.empty() || all.back().range.high_hz < range.low_hz) {
      all.push_back({range, agreed, ratio, ratio});
      continue;
    }
    CloseModes& last = all.back();
    last.agreed += agreed;
    last.range.high_hz = std::max(last.range.high_hz, range.high_hz);
    last.least_ratio = std::min(last.least_ratio, ratio);
    last.greatest_ratio = std::max(last.greatest_ratio, ratio);
  }
  return all;
}

std::vector<Pole> poles_of_all_decays(const MatrixPencil& pencil, const CloseModes& neighbours) {
  std::map<std::size_t, std::vector<std::vector<Pole>>> by_count;
  for (const PolesOfOrder& order : pencil.orders) {
    std::vector<Pole> poles;
    std::ranges::copy_if(order.poles, std::back_inserter(poles),
                         [&](const Pole& pole) { return neighbours.may_hold(pole); });
    if (poles.size() >= std::max<std::size_t>(2, neighbours.agreed)) {
      by_count[poles.size()].push_back(std::move(poles));
    }
  }
  const auto most =
      std::ranges::max_element(by_count, {}, [](const auto& sets) { return sets.second.size(); });
  std::vector<Pole> medians;
  if (most != by_count.end() && std::ssize(most->second) >= min_stable_orders) {
    for (std::size_t k = 0; k < most->first; ++k) {
      medians.push_back({median_of(most->second, k, &Pole::frequency_hz),
                         median_of(most->second, k, &Pole::damping_ratio)});
    }
  }
  return medians;
}

bool may_be_one_nonlinear_mode(const std::vector<Pole>& poles) {
  for (std::size_t i = 0; i < poles.size(); ++i) {
    for (std::size_t k = i + 1; k < poles.size(); ++k) {
      const auto [less, more] = std::minmax(poles[i].damping_ratio, poles[k].damping_ratio);
      const double apart_hz = std::abs(poles[i].frequency_hz - poles[k].frequency_hz);
      if (more > 2.0 * less && apart_hz < 0.2 * less * poles[i].frequency_hz) {
        return true;
      }
    }
  }
  return false;
}

namespace {
constexpr double line_tolerance = 1e-3;
constexpr std::size_t max_groups = 12;
const char* const by_all_taps = "told from its neighbour by all taps together";

double frequency_of(const FittedMode& mode) {
  return mode.pole.frequency_hz;
}

bool is_line(const TapModes& tap, const FittedMode& fitted) {
  return std::ranges::any_of(tap.modes, [&](const TapMode& mode) {
    return mode.standing == Standing::line &&
           std::abs(frequency_of(mode.fitted) / frequency_of(fitted) - 1.0) < line_tolerance;
  });
}

// Whether it is one of the neighbours, as the tap alone shows them.
bool is_among(const CloseModes& neighbours, const TapModes& tap, const FittedMode& fitted) {
  return neighbours.range.holds(frequency_of(fitted)) && !is_line(tap, fitted);
}

// The decays of each channel with its modes beside the neighbours. Empty if one tap is too short
// for so many modes.
std::vector<SharingDecay> sharing(const std::vector<TapModes>& taps, const CloseModes& neighbours,
                                  std::size_t shared) {
  std::vector<SharingDecay> decays;
  for (const TapModes& tap : taps) {
    SharingDecay decay{&tap.spectrum, {}, tap.lines_hz, std::max(tap.fit.noise, 1e-150)};
    for (const FittedMode& fitted : tap.fit.modes) {
      if (!is_among(neighbours, tap, fitted)) {
        decay.own.push_back(fitted.pole);
      }
    }
    if (decay.own.size() + shared > max_mode_count(tap.spectrum, tap.lines_hz)) {
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
    const double of_fit = 2.0 * static_cast<double>(fit.fitted.size());  // two a bin
    deviance += of_fit * std::log(std::max(fit.sum_of_squares, 1e-300) / of_fit);
    unknowns += 2.0 * static_cast<double>(modes);
    values += of_fit;
  }
  void add(const Criterion& other) {
    deviance += other.deviance;
    unknowns += other.unknowns;
    values += other.values;
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

std::vector<Pole> poles_of_impact(const TapModes& tap, const CloseModes& neighbours) {
  std::vector<Pole> poles;
  for (const FittedMode& fitted : tap.fit.modes) {
    if (is_among(neighbours, tap, fitted)) {
      poles.push_back(fitted.pole);
    }
  }
  return poles;
}

// The criterion of the model in which each impact has its own poles, shared by its channels.
Criterion criterion_of_impacts(const std::vector<TapModes>& taps, const std::vector<int>& impacts,
                               const CloseModes& neighbours) {
  std::map<int, std::vector<TapModes>> by_impact;
  for (std::size_t i = 0; i < taps.size(); ++i) {
    by_impact[impacts[i]].push_back(taps[i]);
  }
  Criterion all;
  for (const auto& [impact, channels] : by_impact) {
    std::vector<std::vector<Pole>> poles;
    for (const TapModes& channel : channels) {
      poles.push_back(poles_of_impact(channel, neighbours));
    }
    const std::vector<Pole>& most = *std::ranges::max_element(poles, {}, &std::vector<Pole>::size);
    const std::vector<SharingDecay> decays = channels.size() == 1
                                                 ? std::vector<SharingDecay>{}
                                                 : sharing(channels, neighbours, most.size());
    if (decays.empty()) {  // one channel, or one too short for what another one shows
      for (std::size_t i = 0; i < channels.size(); ++i) {
        all.unknowns += 2.0 * static_cast<double>(poles[i].size());
        all.add(channels[i].fit, poles[i].size());
      }
      continue;
    }
    all.add(criterion_of(fit_shared_poles(decays, most), most.size()));
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

// Each decay's own poles as all together were fitted: what is fitted next begins near its end.
std::vector<SharingDecay> begun_with(const SharedFit& fit, std::size_t shared,
                                     std::vector<SharingDecay> decays) {
  for (std::size_t i = 0; i < decays.size(); ++i) {
    for (std::size_t k = 0; k < decays[i].own.size(); ++k) {
      decays[i].own[k] = fit.decays[i].modes[shared + k].pole;
    }
  }
  return decays;
}

double moved_by(const std::vector<Pole>& poles, const std::vector<Pole>& of_all) {
  double squares = 0.0;
  for (std::size_t k = 0; k < poles.size(); ++k) {
    squares += std::norm(log_of(poles[k], 1.0) - log_of(of_all[k], 1.0));
  }
  return squares;
}

// The shared poles without each group of impacts in turn, at most max_groups groups; empty if one
// of them is not what was found with all. To first order, but for the groups that matter most.
std::vector<std::vector<Pole>> poles_without(const std::vector<SharingDecay>& decays,
                                             const std::vector<int>& impacts,
                                             const std::vector<Pole>& of_all,
                                             const CloseModes& neighbours) {
  constexpr std::size_t fitted_groups = 3;
  const std::set<int> different{impacts.begin(), impacts.end()};
  const std::vector<int> numbers{different.begin(), different.end()};
  const std::size_t groups = std::min(numbers.size(), max_groups);
  if (groups < 2) {
    return {};
  }
  std::vector<std::size_t> group_of;
  for (const int impact : impacts) {
    const auto place = std::ranges::lower_bound(numbers, impact) - numbers.begin();
    group_of.push_back(static_cast<std::size_t>(place) % groups);
  }
  std::vector<std::vector<Pole>> all = shared_poles_without(decays, of_all, group_of, groups);
  std::vector<std::size_t> order(groups);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, std::ranges::greater{},
                    [&](std::size_t group) { return moved_by(all[group], of_all); });
  order.resize(std::min(groups, fitted_groups));
  for (const std::size_t group : order) {
    std::vector<SharingDecay> others;
    for (std::size_t i = 0; i < decays.size(); ++i) {
      if (group_of[i] != group) {
        others.push_back(decays[i]);
      }
    }
    all[group] = shared_poles(fit_shared_poles(others, of_all), of_all.size());
  }
  const bool are_found = std::ranges::all_of(all, [&](const std::vector<Pole>& poles) {
    return std::ranges::all_of(poles, [&](const Pole& pole) { return neighbours.may_hold(pole); });
  });
  return are_found ? all : std::vector<std::vector<Pole>>{};
}

RepeatedMode repeated(const std::vector<std::vector<Pole>>& without, std::size_t k,
                      const SharedFit& together) {
  const FittedMode& fitted = together.decays.front().modes[k];
  std::vector<double> frequencies_hz;
  std::vector<double> ratios;
  for (const std::vector<Pole>& poles : without) {
    frequencies_hz.push_back(poles[k].frequency_hz);
    ratios.push_back(poles[k].damping_ratio);
  }
  const double freedom = together.degrees_of_freedom;
  RepeatedMode mode;
  mode.frequency_hz = jackknife_estimate(fitted.pole.frequency_hz, frequencies_hz,
                                         fitted.frequency_error_hz, freedom);
  mode.damping_ratio =
      jackknife_estimate(fitted.pole.damping_ratio, ratios, fitted.ratio_error, freedom);
  mode.degrees_of_freedom =
      without.size() > 1 ? static_cast<double>(without.size()) - 1.0 : freedom;
  mode.standing = Standing::agreed;
  mode.why = by_all_taps;
  std::vector<double> amplitudes;
  for (const DecayFit& decay : together.decays) {
    amplitudes.push_back(decay.modes[k].amplitude);
  }
  mode.amplitude = quantile(amplitudes, 0.5);
  mode.taps = static_cast<int>(std::ranges::count_if(together.decays, [&](const DecayFit& decay) {
    return decay.modes[k].significance >= min_significance;
  }));
  mode.agreed = mode.taps;
  return mode;
}

void replace_in_tap(const CloseModes& neighbours, const DecayFit& fit, std::size_t shared,
                    TapModes& tap) {
  std::erase_if(tap.modes, [&](const TapMode& mode) {
    return mode.standing != Standing::line && neighbours.range.holds(frequency_of(mode.fitted));
  });
  for (std::size_t k = 0; k < shared; ++k) {
    const bool is_seen = fit.modes[k].significance >= min_significance;
    tap.modes.push_back({fit.modes[k], is_seen ? Standing::agreed : Standing::doubtful,
                         is_seen ? by_all_taps : "not significant in this tap", std::nullopt,
                         min_stable_orders});
  }
  std::ranges::sort(tap.modes, {}, [](const TapMode& mode) { return frequency_of(mode.fitted); });
  tap.fit = fit;
}

// Poles that nothing tells apart may get any amplitudes, if these cancel each other.
bool cancel_each_other(const SharedFit& fit, std::size_t shared,
                       const std::vector<FreeDecay>& decays) {
  constexpr double beyond = 30.0;  // of the largest sample
  std::size_t impossible = 0;
  for (std::size_t i = 0; i < decays.size(); ++i) {
    const double most = beyond * decays[i].samples.cwiseAbs().maxCoeff();
    double largest = 0.0;
    for (std::size_t k = 0; k < shared; ++k) {
      largest = std::max(largest, fit.decays[i].modes[k].amplitude);
    }
    impossible += largest > most ? 1 : 0;
  }
  return 2 * impossible > decays.size();
}

// Changes nothing unless the modes are resolved. recorded: the decays of the taps.
void resolve(const CloseModes& neighbours, const std::vector<Pole>& poles,
             const std::vector<FreeDecay>& recorded, const std::vector<int>& impacts,
             ModesOfTaps& found) {
  const std::vector<SharingDecay> decays = sharing(found.taps, neighbours, poles.size());
  if (decays.empty()) {
    return;
  }
  const SharedFit together = fit_shared_poles(decays, poles);
  const std::vector<Pole> fitted = shared_poles(together, poles.size());
  const bool are_inside =
      together.decays.front().has_converged &&
      std::ranges::all_of(fitted, [&](const Pole& pole) { return neighbours.may_hold(pole); });
  if (!are_inside || may_be_one_nonlinear_mode(fitted) ||
      cancel_each_other(together, poles.size(), recorded) ||
      criterion_of(together, poles.size()).value() >=
          criterion_of_impacts(found.taps, impacts, neighbours).value()) {
    return;
  }
  const std::vector<std::vector<Pole>> without =
      poles_without(begun_with(together, poles.size(), decays), impacts, fitted, neighbours);
  if (without.empty() && std::ranges::count(impacts, impacts.front()) != std::ssize(impacts)) {
    return;
  }
  std::erase_if(found.modes, [&](const RepeatedMode& mode) {
    return mode.standing != Standing::line && neighbours.range.holds(mode.frequency_hz.value);
  });
  for (std::size_t k = 0; k < poles.size(); ++k) {
    found.modes.push_back(repeated(without, k, together));
  }
  for (std::size_t i = 0; i < found.taps.size(); ++i) {
    replace_in_tap(neighbours, together.decays[i], poles.size(), found.taps[i]);
  }
}

double noise_of(const TapModes& tap, const FreeDecay& decay) {
  constexpr double least = 1e-9;  // of the decay: synthetic ones may have none
  const double rms = decay.samples.norm() / std::sqrt(static_cast<double>(decay.samples.size()));
  return std::max({tap.fit.noise, least * rms, 1e-150});
}

// The pencil of the largest group of decays whose rates agree to a thousandth.
MatrixPencil pencil_of(const std::vector<FreeDecay>& decays, const std::vector<TapModes>& taps,
                       const Band& band) {
  const auto is_of = [](double rate_hz) {
    return [rate_hz](const FreeDecay& decay) {
      return std::abs(decay.rate_hz / rate_hz - 1.0) < 1e-3;
    };
  };
  const FreeDecay& commonest = *std::ranges::max_element(decays, {}, [&](const FreeDecay& one) {
    return std::ranges::count_if(decays, is_of(one.rate_hz));
  });
  std::vector<FreeDecay> some;
  std::vector<double> noise;
  for (std::size_t i = 0; i < decays.size(); ++i) {
    if (is_of(commonest.rate_hz)(decays[i])) {
      some.push_back(decays[i]);
      noise.push_back(noise_of(taps[i], decays[i]));
    }
  }
  return matrix_pencil(some, noise, band, max_model_order);
}
}  // namespace

ModesOfTaps resolve_close_modes(const std::vector<FreeDecay>& decays,
                                const std::vector<int>& impacts, const Band& band,
                                const ModesOfTaps& found) {
  ModesOfTaps result = found;
  const MatrixPencil pencil = pencil_of(decays, found.taps, band);
  for (const CloseModes& neighbours : close_modes_among(found.modes)) {
    const std::vector<Pole> poles = poles_of_all_decays(pencil, neighbours);
    if (!poles.empty()) {
      resolve(neighbours, poles, decays, impacts, result);
    }
  }
  std::ranges::sort(result.modes, {},
                    [](const RepeatedMode& mode) { return mode.frequency_hz.value; });
  return result;
}
}  // namespace tapstudy::analysis
