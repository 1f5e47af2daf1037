#include "analysis/modal/modes/distinct_modes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <set>

#include "analysis/modal/decay/decay_band.hpp"
#include "analysis/modal/decay/resting_pole_fit.hpp"
#include "analysis/modal/modes/one_resonance.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
// What may belong to one mode lies within this share of its frequency or so many half-power
// bandwidths of it: joints and cubic stiffness move frequencies by a few per cent.
constexpr double reach_share = 0.04;
constexpr double reach_bandwidths = 4.0;
constexpr double most_reach = 0.15;
constexpr double around_reach = 1.5;
constexpr double least_bins = 24.0;
constexpr double explains_as_much = 1.05;  // of the noise
constexpr double most_times_damped = 5.0;  // at a tap, by joints
constexpr std::array<int, 5> numbers_of_terms{1, 2, 3, 4, 6};

double centre_of(const RepeatedMode& mode) {
  return mode.frequency_hz.value;
}

bool may_be_mode(const RepeatedMode& mode) {
  return mode.standing == Standing::agreed || mode.standing == Standing::doubtful;
}

double bandwidth_hz(const RepeatedMode& mode) {
  return 2.0 * std::abs(mode.damping_ratio.value) * centre_of(mode);
}

double reach_of(const RepeatedMode& mode) {
  return std::min(most_reach * centre_of(mode),
                  std::max(reach_share * centre_of(mode), reach_bandwidths * bandwidth_hz(mode)));
}

// In a longer decay a mode is so well known that what its neighbours leave in its surroundings
// shifts the fit of it alone by more than its interval: there modes stay as the taps show them.
constexpr double longest_examined_s = 0.3;

// What a tap shows beyond a part of the band, so many samples later.
std::vector<TapMode> beyond(const Band& part, const TapModes& tap, double later) {
  std::vector<TapMode> modes;
  std::ranges::copy_if(tap.modes, std::back_inserter(modes), [&](const TapMode& mode) {
    return !part.holds(mode.fitted.pole.frequency_hz);
  });
  for (TapMode& mode : modes) {
    const std::complex<double> log_z = log_of(mode.fitted.pole, tap.spectrum.rate_hz);
    mode.fitted.amplitude *= std::exp(log_z.real() * later);
    mode.fitted.phase_rad += log_z.imag() * later;
  }
  return modes;
}

// How strongly a mode is moved at rest, before the tap: the amplitude of one tone with the power
// inside its bandwidth. 0 where that is too short to tell.
double amplitude_at_rest(const RepeatedMode& mode, const FreeDecay& rest) {
  constexpr double around = 1.5;
  const double centre_hz = centre_of(mode);
  try {
    const BandSpectrum spectrum = band_spectrum(
        about_mean(rest), {centre_hz / around, std::min(0.47 * rest.rate_hz, around * centre_hz)});
    const double within_hz =
        std::max(bandwidth_hz(mode), spectrum.rate_hz / static_cast<double>(spectrum.length));
    const Eigen::ArrayXd hz = spectrum.rate_hz / (2.0 * std::numbers::pi) * spectrum.rad_per_sample;
    const double power = ((hz - centre_hz).abs() <= within_hz)
                             .select(spectrum.values.cwiseAbs2().array(), 0.0)
                             .sum();
    return 2.0 * std::sqrt(power) / static_cast<double>(spectrum.length);
  } catch (const core::InvalidInput&) {
    return 0.0;
  }
}

class Neighbourhood {
 public:
  // The decays begin so much later than those of the taps. What the taps show beyond the
  // neighbourhood is taken out: in a short decay it would look like a mode here that follows its
  // amplitude.
  Neighbourhood(const RepeatedMode& strongest, const std::vector<FreeDecay>& decays,
                const std::vector<int>& impacts, const Band& band, const ModesOfTaps& found,
                double later_s = 0.0)
      : strongest_{strongest}, found_{found}, reach_hz_{reach_of(strongest)} {
    const double centre_hz = centre_of(strongest);
    for (std::size_t i = 0; i < decays.size(); ++i) {
      if (decays[i].duration_s() >= longest_examined_s) {
        throw core::InvalidInput{"a decay is too long for one mode's fit"};
      }
      const FreeDecay decay = shortened_for({centre_hz, centre_hz}, decays[i]);
      const double half_hz =
          std::max(around_reach * reach_hz_, least_bins / 2.0 / decay.duration_s());
      near_ = {std::max(band.low_hz, centre_hz - half_hz),
               std::min(0.47 * decay.rate_hz, centre_hz + half_hz)};
      const double later = std::round(later_s * decay.rate_hz);
      const FreeDecay alone = without_modes(decay, beyond(near_, found.taps[i], later));
      decays_.push_back({band_spectrum(alone, near_), lines_in(found.taps[i], near_), impacts[i]});
    }
  }

  bool holds(const RepeatedMode& mode) const {
    return may_be_mode(mode) && std::abs(centre_of(mode) - centre_of(strongest_)) <= reach_hz_;
  }

  // The best single mode that follows its amplitude; unset if none settles.
  std::optional<RestingFit> single(int most_terms = numbers_of_terms.back()) const {
    std::optional<RestingFit> best;
    for (const int terms : numbers_of_terms) {
      if (terms > most_terms) {
        break;
      }
      try {
        RestingFit fit = fit_resting_poles(decays_, start_with(terms, best));
        if (fit.has_converged && (!best || fit.criterion < best->criterion)) {
          best = std::move(fit);
        }
      } catch (const core::InvalidInput&) {
        break;
      }
    }
    return best && is_here(*best) ? best : std::nullopt;
  }

  // The mode that all of it is; unset if it is not one. rests: before the taps.
  std::optional<RepeatedMode> one_mode(const std::vector<FreeDecay>& rests) const {
    const std::vector<RepeatedMode> members = all_held();
    const std::optional<RestingFit> best = supported_single(rests);
    if (!best) {
      return std::nullopt;
    }
    if (members.size() == 1 && best->poles.front().terms == 1) {
      return std::nullopt;  // it is linear, and stays as the taps show it
    }
    if (best->criterion > criterion_of_several(members, *best)) {
      return std::nullopt;
    }
    return as_repeated(*best);
  }

 private:
  // What is left of a tone that was taken out looks like a mode that follows its amplitude.
  std::optional<RestingFit> supported_single(const std::vector<FreeDecay>& rests) const {
    const bool is_beside_tone = std::ranges::any_of(found_.taken_hz, [&](double hz) {
      return std::abs(hz - centre_of(strongest_)) <= reach_hz_;
    });
    std::optional<RestingFit> best = single(is_beside_tone ? 1 : numbers_of_terms.back());
    if (!best || best->poles.front().terms == 1) {
      return best;
    }
    const std::optional<RestingFit> linear = single(1);
    return is_free_decay(*best) && (!linear || exceeds_rest(*linear, *best, rests)) ? best : linear;
  }

  // What moves the mode at rest goes on after its decay, in which a series would follow it: what a
  // series explains beyond a linear mode must be more than that.
  bool exceeds_rest(const RestingFit& linear, const RestingFit& series,
                    const std::vector<FreeDecay>& rests) const {
    constexpr double times_rest = 2.0;
    std::vector<double> at_rest;
    for (const FreeDecay& rest : rests) {
      at_rest.push_back(amplitude_at_rest(strongest_, rest));
    }
    const BandSpectrum& spectrum = decays_.front().spectrum;
    const double share_of_band =
        static_cast<double>(spectrum.values.size()) / static_cast<double>(spectrum.length);
    const double explained =
        2.0 * std::sqrt(share_of_band *
                        std::max(0.0, linear.noise * linear.noise - series.noise * series.noise));
    return at_rest.empty() || explained > times_rest * quantile(at_rest, 0.5);
  }

  // At a tap, too, a mode loses energy, though not many times as fast as at rest: that is the blow;
  // what follows its amplitude does so alike in most taps; and what is at rest is known if it falls
  // by e within a decay.
  bool is_free_decay(const RestingFit& fit) const {
    const Pole& rest = fit.poles.front().pole;
    const BandSpectrum& first = decays_.front().spectrum;
    const double fall = 2.0 * std::numbers::pi * rest.frequency_hz * rest.damping_ratio *
                        static_cast<double>(first.length) / first.rate_hz;
    const double ratio_at_taps = at_taps(fit).damping_ratio;
    return fall >= 1.0 && ratio_at_taps > 0.0 &&
           ratio_at_taps <= most_times_damped * rest.damping_ratio &&
           (most_move_alike(fit, &Pole::frequency_hz, rest.frequency_hz) ||
            most_move_alike(fit, &Pole::damping_ratio, rest.damping_ratio));
  }

  static bool most_move_alike(const RestingFit& fit, double Pole::*part, double at_rest) {
    constexpr double most = 0.8;
    const auto up = std::ranges::count_if(
        fit.seen, [&](const SeenAtTap& seen) { return seen.pole.*part > at_rest; });
    const double share = static_cast<double>(up) / static_cast<double>(fit.seen.size());
    return std::max(share, 1.0 - share) >= most;
  }

  static std::vector<double> lines_in(const TapModes& tap, const Band& near) {
    std::vector<double> lines;
    std::ranges::copy_if(tap.lines_hz, std::back_inserter(lines),
                         [&](double hz) { return near.holds(hz); });
    for (const TapMode& mode : tap.modes) {
      if (mode.standing == Standing::line && near.holds(mode.fitted.pole.frequency_hz)) {
        lines.push_back(mode.fitted.pole.frequency_hz);
      }
    }
    return lines;
  }

  std::vector<RepeatedMode> all_held() const {
    std::vector<RepeatedMode> members;
    std::ranges::copy_if(found_.modes, std::back_inserter(members),
                         [&](const RepeatedMode& mode) { return holds(mode); });
    return members;
  }

  // Others inside the band but beyond reach take part as linear modes.
  std::vector<RestingPole> start_with(int terms, const std::optional<RestingFit>& before) const {
    std::vector<RestingPole> start;
    if (before) {
      start = before->poles;
    } else {
      start.push_back({{centre_of(strongest_), std::max(1e-4, strongest_.damping_ratio.value)}, 1});
      for (const RepeatedMode& mode : found_.modes) {
        if (mode.standing == Standing::agreed && near_.holds(centre_of(mode)) && !holds(mode) &&
            mode.damping_ratio.value > 0.0) {
          start.push_back({{centre_of(mode), mode.damping_ratio.value}, 1});
        }
      }
    }
    start.front().terms = terms;
    return start;
  }

  bool is_here(const RestingFit& fit) const {
    const Pole& pole = fit.poles.front().pole;
    return std::abs(pole.frequency_hz - centre_of(strongest_)) <= reach_hz_ &&
           pole.damping_ratio > 0.0 && pole.damping_ratio < 0.5;
  }

  // As the taps show them each for itself, or, told apart, all together.
  double criterion_of_several(const std::vector<RepeatedMode>& members,
                              const RestingFit& single) const {
    return std::min(criterion_of_own(), criterion_together(members, single));
  }

  double criterion_of_own() const {
    std::vector<std::vector<Pole>> own;
    for (const TapModes& tap : found_.taps) {
      std::vector<Pole> poles;
      for (const FittedMode& fitted : tap.fit.modes) {
        if (near_.holds(fitted.pole.frequency_hz)) {
          poles.push_back(fitted.pole);
        }
      }
      own.push_back(std::move(poles));
    }
    try {
      const OwnPoles of_own = deviance_of_own(decays_, own);
      return schwarz(of_own.deviance, of_own.unknowns, decays_);
    } catch (const core::InvalidInput&) {
      return std::numeric_limits<double>::infinity();  // more poles than the band can tell
    }
  }

  double criterion_together(const std::vector<RepeatedMode>& members,
                            const RestingFit& single) const {
    constexpr double impossible = std::numeric_limits<double>::infinity();
    std::vector<RestingPole> together;
    for (const RepeatedMode& mode : found_.modes) {
      if (mode.standing == Standing::agreed && near_.holds(centre_of(mode)) &&
          mode.damping_ratio.value > 0.0) {
        together.push_back({{centre_of(mode), mode.damping_ratio.value}, 1});
      }
    }
    if (together.size() < 2 || members.size() < 2) {
      return impossible;
    }
    try {
      const RestingFit several = fit_resting_poles(decays_, together);
      const bool is_needed =
          !may_be_series(members) || single.noise > explains_as_much * several.noise;
      return is_needed ? several.criterion : impossible;
    } catch (const core::InvalidInput&) {
      return impossible;
    }
  }

  // The first terms of one mode's series decay at rates of 1 to 2 or 3, at nearly one frequency.
  static bool may_be_series(const std::vector<RepeatedMode>& members) {
    for (const RepeatedMode& one : members) {
      for (const RepeatedMode& other : members) {
        const double faster_hz = one.damping_ratio.value * centre_of(one);
        const double slower_hz = other.damping_ratio.value * centre_of(other);
        if (one.standing == Standing::agreed && other.standing == Standing::agreed &&
            faster_hz > series_ratio * slower_hz &&
            std::abs(centre_of(one) - centre_of(other)) < faster_hz) {
          return true;
        }
      }
    }
    return false;
  }

  RepeatedMode as_repeated(const RestingFit& fit) const {
    const Pole& pole = fit.poles.front().pole;
    const Pole errors = noise_errors(decays_, fit);
    std::vector<double> frequencies_hz;
    std::vector<double> ratios;
    for (const Pole& one : without_each_impact(decays_, fit)) {
      frequencies_hz.push_back(one.frequency_hz);
      ratios.push_back(one.damping_ratio);
    }
    RepeatedMode mode = strongest_;
    const double freedom = 2.0 * static_cast<double>(decays_.front().spectrum.values.size());
    mode.frequency_hz =
        jackknife_estimate(pole.frequency_hz, frequencies_hz, errors.frequency_hz, freedom);
    mode.damping_ratio =
        jackknife_estimate(pole.damping_ratio, ratios, errors.damping_ratio, freedom);
    mode.degrees_of_freedom =
        ratios.size() > 1 ? static_cast<double>(ratios.size()) - 1.0 : freedom;
    mode.scatter_p.reset();
    if (fit.poles.front().terms > 1) {
      mode.at_tap = at_taps(fit);
    }
    mode.taps = static_cast<int>(decays_.size());
    mode.agreed = static_cast<int>(
        std::ranges::count_if(fit.seen, [](const SeenAtTap& seen) { return seen.share > 0.5; }));
    if (2 * mode.agreed >= mode.taps || strongest_.standing == Standing::agreed) {
      mode.standing = Standing::agreed;
      mode.why = {};
    }
    return mode;
  }

  static AtTap at_taps(const RestingFit& fit) {
    std::vector<double> frequencies_hz;
    std::vector<double> ratios;
    for (const SeenAtTap& seen : fit.seen) {
      frequencies_hz.push_back(seen.pole.frequency_hz);
      ratios.push_back(seen.pole.damping_ratio);
    }
    return {quantile(frequencies_hz, 0.5), quantile(ratios, 0.5)};
  }

  RepeatedMode strongest_;
  const ModesOfTaps& found_;
  double reach_hz_;
  Band near_;
  std::vector<NearbyDecay> decays_;
};
}  // namespace

namespace {
std::vector<RepeatedMode> by_strength(const std::vector<RepeatedMode>& modes) {
  std::vector<RepeatedMode> sorted;
  std::ranges::copy_if(modes, std::back_inserter(sorted), [](const RepeatedMode& mode) {
    return may_be_mode(mode) && mode.damping_ratio.value > 0.0;
  });
  std::ranges::sort(sorted, std::ranges::greater{}, &RepeatedMode::amplitude);
  return sorted;
}
}  // namespace

FreeDecay begun_later(const FreeDecay& decay, double after_s) {
  const auto skipped = std::min(static_cast<Eigen::Index>(std::lround(after_s * decay.rate_hz)),
                                decay.samples.size());
  return {decay.rate_hz, decay.samples.tail(decay.samples.size() - skipped)};
}

namespace {
// A room's and a table's first reflections have come by then; later on weak modes are lost.
constexpr std::array<double, 3> delays_s{0.0, 0.006, 0.012};
constexpr double as_well = 1.15;

// For one mode, by the decays that begin so much later in turn.
double settled_for(const RepeatedMode& mode, const std::vector<std::vector<FreeDecay>>& later,
                   const std::vector<int>& impacts, const Band& band, const ModesOfTaps& found) {
  const double decay_per_s = 2.0 * std::numbers::pi * centre_of(mode) * mode.damping_ratio.value;
  // A term that dies away sooner than a blow lasts would take its reflections for the mode.
  const int most_terms = std::max(1, static_cast<int>(1.0 / (blow_s * decay_per_s)));
  std::vector<double> noise;
  for (std::size_t i = 0; i < delays_s.size(); ++i) {
    if (delays_s.at(i) * decay_per_s > 2.0) {
      break;  // too little of the mode would be left
    }
    try {
      const auto fit =
          Neighbourhood{mode, later[i], impacts, band, found, delays_s.at(i)}.single(most_terms);
      if (!fit) {
        break;
      }
      noise.push_back(fit->noise);
    } catch (const core::InvalidInput&) {
      break;
    }
  }
  for (std::size_t i = 0; i < noise.size(); ++i) {
    if (noise[i] <= as_well * *std::ranges::min_element(noise)) {
      return delays_s.at(i);
    }
  }
  return 0.0;
}
}  // namespace

double settled_after_s(const std::vector<FreeDecay>& decays, const std::vector<int>& impacts,
                       const Band& band, const ModesOfTaps& found) {
  constexpr std::size_t most_modes = 6;
  std::vector<RepeatedMode> strongest = by_strength(found.modes);
  std::erase_if(strongest,
                [](const RepeatedMode& mode) { return mode.standing != Standing::agreed; });
  strongest.resize(std::min(strongest.size(), most_modes));
  std::vector<std::vector<FreeDecay>> later;
  for (const double delay_s : delays_s) {
    std::vector<FreeDecay>& some = later.emplace_back();
    for (const FreeDecay& decay : decays) {
      some.push_back(begun_later(decay, delay_s));
    }
  }
  double settled_s = 0.0;
  for (const RepeatedMode& mode : strongest) {
    settled_s = std::max(settled_s, settled_for(mode, later, impacts, band, found));
  }
  return settled_s;
}

namespace {
bool are_near(const RepeatedMode& one, const RepeatedMode& other) {
  return std::abs(centre_of(one) - centre_of(other)) < bandwidth_hz(one) + bandwidth_hz(other);
}

void widen(double by, Estimate& estimate) {
  estimate.standard_error = std::hypot(estimate.standard_error, by / 2.0);
  estimate.interval.low -= by;
  estimate.interval.high += by;
  estimate.bootstrap.reset();
}

// A decay begins 2 ms after the largest value (taps.hpp), when some modes have fallen by half.
double amplitude_at_blow(const RepeatedMode& mode) {
  constexpr double before_s = 0.002;
  constexpr double most_fall = 1.0;  // nepers
  return mode.amplitude *
         std::exp(std::clamp(std::numbers::pi * bandwidth_hz(mode) * before_s, 0.0, most_fall));
}

// The strongest mode may be doubtful in the beginning, which its reflections disturb.
double strongest_agreed(const std::vector<RepeatedMode>& modes) {
  double strongest = 0.0;
  for (const RepeatedMode& mode : modes) {
    strongest =
        std::max(strongest, mode.standing == Standing::agreed ? amplitude_at_blow(mode) : 0.0);
  }
  return strongest;
}

// Reflections of the blow make weaker ones beside a strong mode, and much weaker ones elsewhere.
bool exceeds_reflections(const RepeatedMode& mode, double strongest,
                         const std::vector<RepeatedMode>& all) {
  constexpr double least_beside = 0.1;
  constexpr double least_alone = 0.06;
  const bool is_beside = std::ranges::any_of(all, [&](const RepeatedMode& other) {
    return other.standing == Standing::agreed && other.amplitude > mode.amplitude &&
           std::abs(centre_of(other) - centre_of(mode)) < most_reach * centre_of(other);
  });
  return is_beside ? mode.amplitude >= least_beside * strongest
                   : amplitude_at_blow(mode) >= least_alone * strongest;
}

// Where only the blow with its reflections shows a mode, they shift its pole by up to a third of
// its decay rate.
RepeatedMode seen_in_blow(RepeatedMode mode) {
  constexpr double shift = 1.0 / 3.0;
  widen(shift * bandwidth_hz(mode) / 2.0, mode.frequency_hz);
  widen(shift * mode.damping_ratio.value, mode.damping_ratio);
  mode.at_tap.reset();
  return mode;
}
}  // namespace

std::vector<RepeatedMode> died_before(double after_s, const std::vector<RepeatedMode>& first,
                                      const std::vector<RepeatedMode>& later) {
  constexpr double least_fall = 0.4;  // nepers
  const double strongest = std::max(strongest_agreed(first), strongest_agreed(later));
  std::vector<RepeatedMode> died;
  std::ranges::copy_if(first, std::back_inserter(died), [&](const RepeatedMode& mode) {
    return mode.standing == Standing::agreed && exceeds_reflections(mode, strongest, first) &&
           std::numbers::pi * bandwidth_hz(mode) * after_s > least_fall &&
           std::ranges::none_of(later, [&](const RepeatedMode& other) {
             return other.standing == Standing::agreed && are_near(mode, other);
           });
  });
  std::ranges::transform(died, died.begin(), seen_in_blow);
  return died;
}

void add_died(const std::vector<RepeatedMode>& died, std::vector<RepeatedMode>& later) {
  std::erase_if(later, [&](const RepeatedMode& left) {
    return left.standing == Standing::doubtful &&
           std::ranges::any_of(died,
                               [&](const RepeatedMode& mode) { return are_near(mode, left); });
  });
  const auto rings_on = [&, known = later](const RepeatedMode& mode) {
    return std::ranges::any_of(known, [&](const RepeatedMode& other) {
      return other.standing == Standing::agreed && are_near(mode, other);
    });
  };
  std::ranges::remove_copy_if(died, std::back_inserter(later), rings_on);
  std::ranges::sort(later, {}, [](const RepeatedMode& mode) { return centre_of(mode); });
}

std::vector<RepeatedMode> distinct_modes(const std::vector<FreeDecay>& decays,
                                         const std::vector<int>& impacts, const Band& band,
                                         const ModesOfTaps& found,
                                         const std::vector<FreeDecay>& rests) {
  ModesOfTaps left = found;
  std::set<double> taken_hz;
  for (const RepeatedMode& strongest : by_strength(found.modes)) {
    if (taken_hz.contains(centre_of(strongest))) {
      continue;
    }
    try {
      const Neighbourhood near{strongest, decays, impacts, band, left};
      if (const std::optional<RepeatedMode> one = near.one_mode(rests)) {
        std::erase_if(left.modes, [&](const RepeatedMode& mode) {
          const bool is_part = near.holds(mode);
          if (is_part) {
            taken_hz.insert(centre_of(mode));
          }
          return is_part;
        });
        left.modes.push_back(*one);
        taken_hz.insert(centre_of(*one));
      }
    } catch (const core::InvalidInput&) {
      continue;  // a decay too short for so narrow a band: it stays as it is
    }
  }
  std::ranges::sort(left.modes, {}, [](const RepeatedMode& mode) { return centre_of(mode); });
  return left.modes;
}
}  // namespace tapstudy::analysis
