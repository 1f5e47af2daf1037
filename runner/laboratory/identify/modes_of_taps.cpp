#include "runner/laboratory/identify/modes_of_taps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include "analysis/modal/decay/decay_band.hpp"
#include "analysis/modal/modes/close_modes.hpp"
#include "analysis/modal/modes/distinct_modes.hpp"
#include "analysis/modal/modes/mode_kinds.hpp"
#include "analysis/modal/modes/neighbourhood_fit.hpp"
#include "analysis/modal/modes/one_resonance.hpp"
#include "analysis/modal/modes/steady_tone.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "analysis/statistics/resampling/replicates.hpp"
#include "core/error.hpp"
namespace tapstudy::runner {
namespace {
constexpr double default_low_hz = 10.0;
constexpr double sinusoid_high_hz = 1000.0;
constexpr double usable_rate_share = 0.4;  // of the rate; sensors' own filters begin above
constexpr double max_rate_share = 0.47;
constexpr double told_energy_outside = 0.01;

std::vector<analysis::FreeDecay> decays_of(const std::vector<IdentifiedTap>& taps) {
  std::vector<analysis::FreeDecay> decays;
  for (const IdentifiedTap& tap : taps) {
    decays.push_back(tap.decay);
  }
  return decays;
}

analysis::Band band_sought(const TapQuestion& question,
                           const std::vector<analysis::FreeDecay>& decays,
                           std::optional<double> band_limit_hz) {
  const double rate_hz =
      std::ranges::min_element(decays, {}, &analysis::FreeDecay::rate_hz)->rate_hz;
  if (question.band) {
    return *question.band;
  }
  const double usable_hz = usable_rate_share * rate_hz;
  return {default_low_hz, std::min({usable_hz, analysis::band_end_hz(decays, default_low_hz),
                                    band_limit_hz.value_or(usable_hz)})};
}
}  // namespace

void check_band(const TapQuestion& question, double rate_hz) {
  if (question.band && question.band->high_hz > max_rate_share * rate_hz) {
    throw core::InvalidInput{fmt::format("--band: ends at {:g} Hz, above {} of the rate of {:g} Hz",
                                         question.band->high_hz, max_rate_share, rate_hz)};
  }
}

namespace {
// Whether most taps answer at this frequency: twice as strongly as what is there at rest.
bool do_answer(double frequency_hz, const std::vector<IdentifiedTap>& taps) {
  const auto answering = std::ranges::count_if(taps, [&](const IdentifiedTap& tap) {
    return analysis::amplitude_at(frequency_hz, tap.decay) >
           2.0 * analysis::amplitude_at(frequency_hz, tap.rest);
  });
  return 2 * answering > std::ssize(taps);
}

double median_duration_s(const std::vector<IdentifiedTap>& taps) {
  std::vector<double> durations_s;
  for (const IdentifiedTap& tap : taps) {
    durations_s.push_back(tap.decay.duration_s());
  }
  return analysis::quantile(durations_s, 0.5);
}

// Where modes are sought in a band at the lowest, whatever it begins with.
double sought_from_hz(const analysis::Band& band) {
  return std::min(default_low_hz, band.low_hz);
}

// What the taps move below the band, where the first modes of a slender body may lie: unset where
// it has little energy, or as much at rest.
std::optional<analysis::EnergyOutside> motion_below(const analysis::Band& band,
                                                    const std::vector<IdentifiedTap>& taps) {
  const double begins_hz = sought_from_hz(band);
  const double lowest_hz = analysis::min_periods / median_duration_s(taps);
  if (!(lowest_hz < begins_hz)) {
    return std::nullopt;
  }
  const analysis::Band above{begins_hz, std::numeric_limits<double>::infinity()};
  const analysis::EnergyOutside slow = analysis::energy_outside(decays_of(taps), above, lowest_hz);
  const bool is_motion = slow.share > told_energy_outside && do_answer(slow.peak_hz, taps);
  return is_motion ? std::optional{slow} : std::nullopt;
}
}  // namespace

analysis::Band modal_band(const TapQuestion& question, const std::vector<IdentifiedTap>& taps,
                          std::optional<double> band_limit_hz, std::vector<std::string>& remarks) {
  const std::vector<analysis::FreeDecay> decays = decays_of(taps);
  const analysis::Band band = band_sought(question, decays, band_limit_hz);
  const double begins_hz = sought_from_hz(band);
  if (const auto slow = motion_below(band, taps)) {
    remarks.push_back(fmt::format(
        "{:.0f} % of the taps' energy lies below {:g} Hz, where the band begins, most of it near "
        "{:.3g} Hz: modes there are not sought (--band)",
        100.0 * slow->share, begins_hz, slow->peak_hz));
  }
  const analysis::EnergyOutside outside = analysis::energy_outside(decays, band, begins_hz);
  if (outside.share > told_energy_outside) {
    remarks.push_back(fmt::format(
        "{:.0f} % of the taps' energy lies outside the band of {:g} to {:g} Hz, most of it near "
        "{:.4g} Hz (--band)",
        100.0 * outside.share, band.low_hz, band.high_hz, outside.peak_hz));
  }
  return band;
}

analysis::Band band_of_sinusoid(const analysis::Band& sought, double rate_hz) {
  return {sought.low_hz,
          std::max(sought.high_hz, std::min(sinusoid_high_hz, usable_rate_share * rate_hz))};
}

namespace {
// All taps in one part of the band.
struct PartOfBand {
  analysis::Band band;
  std::vector<std::size_t> taps;  // that are long enough: indices
  std::vector<analysis::FreeDecay> decays;
  std::vector<int> impacts;
  std::vector<analysis::TapModes> modes;
};

// What a fit of one tap gave, or why there is none.
struct FitOfTap {
  std::optional<analysis::TapModes> modes;
  std::string refusal;
};

// Taps are fitted on all processors; a fit depends on its tap alone. None where it throws.
std::vector<FitOfTap> fitted_taps(std::size_t count,
                                  const std::function<analysis::TapModes(std::size_t)>& fit) {
  std::vector<FitOfTap> fits(count);
  analysis::parallel_for(count, 0, [&](std::size_t k) {
    try {
      fits[k].modes = fit(k);
    } catch (const core::InvalidInput& error) {
      fits[k].refusal = error.what();
    }
  });
  return fits;
}

// What the tap's sensor shows at rest: before the tap, or where that is short before another one.
const analysis::FreeDecay& silence_of(const IdentifiedTap& tap,
                                      const std::vector<IdentifiedTap>& taps) {
  const IdentifiedTap* longest = &tap;
  for (const IdentifiedTap& other : taps) {
    const bool is_short = longest->rest.samples.size() == 0 ||
                          longest->rest.duration_s() < analysis::shortest_stretch_s;
    if (is_short && other.file == tap.file && other.channel == tap.channel &&
        other.rest.samples.size() > longest->rest.samples.size()) {
      longest = &other;
    }
  }
  return longest->rest;
}

PartOfBand identified_in(const analysis::Band& band, const std::vector<IdentifiedTap>& taps,
                         TapRemarks& remarks) {
  PartOfBand part{band, {}, {}, {}, {}};
  std::vector<analysis::FreeDecay> decays;
  for (const IdentifiedTap& tap : taps) {
    decays.push_back(analysis::shortened_for(band, tap.decay));
  }
  std::vector<FitOfTap> fits = fitted_taps(taps.size(), [&](std::size_t i) {
    return analysis::identify_modes(decays[i], band, silence_of(taps[i], taps));
  });
  for (std::size_t i = 0; i < taps.size(); ++i) {
    if (!fits[i].modes) {
      remarks.add(taps[i].file,
                  {taps[i].time_s, fmt::format("left out, {}", fits[i].refusal), std::string{}});
      continue;
    }
    part.modes.push_back(std::move(*fits[i].modes));
    part.taps.push_back(i);
    part.decays.push_back(std::move(decays[i]));
    part.impacts.push_back(taps[i].impact);
  }
  return part;
}

void share_lines(const std::vector<IdentifiedTap>& taps, PartOfBand& part, TapRemarks& remarks) {
  const std::vector<analysis::TapModes> alone = part.modes;
  std::vector<FitOfTap> fits = fitted_taps(part.taps.size(), [&](std::size_t k) {
    std::vector<double> lines_hz = analysis::missed_lines(alone[k], alone);
    std::ranges::copy_if(taps[part.taps[k]].beside_hz, std::back_inserter(lines_hz),
                         [&, known = lines_hz](double hz) {
                           return part.band.holds(hz) && !analysis::is_among_lines(hz, known);
                         });
    return lines_hz.empty() ? alone[k]
                            : analysis::with_lines(alone[k], part.decays[k], part.band, lines_hz,
                                                   silence_of(taps[part.taps[k]], taps));
  });
  for (std::size_t k = 0; k < fits.size(); ++k) {
    if (fits[k].modes) {
      part.modes[k] = std::move(*fits[k].modes);
      continue;
    }
    const IdentifiedTap& tap = taps[part.taps[k]];
    remarks.add(tap.file, {tap.time_s,
                           "too short for the steady tones that other taps show: they may falsify "
                           "its damping",
                           fits[k].refusal});
  }
}

// What the part found in a tap is taken from its decay.
void take_modes(const PartOfBand& part, std::size_t tap, analysis::FreeDecay& decay) {
  const auto place = std::ranges::find(part.taps, tap);
  if (place != part.taps.end()) {
    const auto k = static_cast<std::size_t>(place - part.taps.begin());
    decay = analysis::without_modes(std::move(decay), part.modes[k].modes);
  }
}

// The modes that each part found alone are taken from the decays of all others, whose own are then
// fitted again.
void free_from_one_another(const std::vector<IdentifiedTap>& taps, std::vector<PartOfBand>& parts) {
  for (PartOfBand& part : parts) {
    for (const PartOfBand& other : parts) {
      for (std::size_t k = 0; &other != &part && k < part.taps.size(); ++k) {
        take_modes(other, part.taps[k], part.decays[k]);
      }
    }
  }
  for (PartOfBand& part : parts) {
    analysis::parallel_for(part.taps.size(), 0, [&](std::size_t k) {
      part.modes[k] =
          analysis::with_lines(part.modes[k], part.decays[k], part.band, part.modes[k].lines_hz,
                               silence_of(taps[part.taps[k]], taps));
    });
  }
}

// Part by part of the band; taps that are too short for all of them are left out.
analysis::ModesOfTaps found_in_parts(const analysis::Band& band, std::vector<IdentifiedTap>& taps,
                                     const std::vector<double>& taken_hz, TapRemarks& remarks) {
  std::vector<std::vector<analysis::TapModes>> pieces(taps.size());
  std::vector<PartOfBand> parts;
  for (const analysis::Band& of_part : analysis::parts_of(band, decays_of(taps))) {
    PartOfBand part = identified_in(of_part, taps, remarks);
    if (!part.taps.empty()) {
      share_lines(taps, part, remarks);
      parts.push_back(std::move(part));
    }
  }
  if (parts.size() > 1) {
    free_from_one_another(taps, parts);
  }
  analysis::ModesOfTaps found{{}, {}, taken_hz};
  for (const PartOfBand& part : parts) {
    analysis::ModesOfTaps in_part = analysis::resolve_close_modes(
        part.decays, part.impacts, part.band,
        {part.modes, analysis::modes_over_taps(part.modes, part.impacts)});
    found.modes.insert(found.modes.end(), in_part.modes.begin(), in_part.modes.end());
    for (std::size_t k = 0; k < part.taps.size(); ++k) {
      pieces[part.taps[k]].push_back(std::move(in_part.taps[k]));
    }
  }
  std::vector<IdentifiedTap> left;
  for (std::size_t i = 0; i < taps.size(); ++i) {
    if (!pieces[i].empty()) {
      left.push_back(std::move(taps[i]));
      left.back().modes = analysis::joined(left.back().decay, band, pieces[i]);
      found.taps.push_back(left.back().modes);
    }
  }
  taps = std::move(left);
  return found;
}

std::vector<analysis::FreeDecay> rests_of(const std::vector<IdentifiedTap>& taps) {
  std::vector<analysis::FreeDecay> rests;
  std::ranges::transform(taps, std::back_inserter(rests), &IdentifiedTap::rest);
  return rests;
}

std::vector<int> impacts_of(const std::vector<IdentifiedTap>& taps) {
  std::vector<int> impacts;
  std::ranges::transform(taps, std::back_inserter(impacts), &IdentifiedTap::impact);
  return impacts;
}

void begin_later(double after_s, std::vector<IdentifiedTap>& taps, TapRemarks& remarks) {
  for (IdentifiedTap& tap : taps) {
    const Eigen::Index before = tap.decay.samples.size();
    tap.decay = analysis::begun_later(tap.decay, after_s);
    tap.tap.begin += static_cast<std::size_t>(before - tap.decay.samples.size());
    remarks.add(
        tap.file,
        {tap.time_s,
         fmt::format("free only {:g} ms later than it seems (reflections of the blow?), the "
                     "decay is taken from there on",
                     1e3 * after_s),
         {}});
  }
}
// How often displacement was differentiated.
int derivatives_of(analysis::Quantity quantity) {
  switch (quantity) {
    case analysis::Quantity::acceleration:
      return 2;
    case analysis::Quantity::velocity:
      return 1;
    case analysis::Quantity::displacement:
      break;
  }
  return 0;
}
}  // namespace

namespace {
bool is_one_impact(const std::vector<IdentifiedTap>& taps) {
  const std::vector<int> impacts = impacts_of(taps);
  return std::ranges::count(impacts, impacts.front()) == std::ssize(impacts);
}

// Of one impact that several sensors saw; unset for others, whose strength differs.
analysis::Likeness likeness_over_sensors(const std::vector<IdentifiedTap>& taps,
                                         const std::vector<analysis::RepeatedMode>& modes) {
  constexpr std::size_t fewest_sensors = 3;
  if (taps.size() < fewest_sensors || !is_one_impact(taps)) {
    return {};
  }
  return [decays = decays_of(taps), modes](std::size_t one, std::size_t other) {
    return analysis::likeness_over(decays, modes, one, other);
  };
}

// Taps that are long enough, with what was found in them.
struct FoundInTaps {
  std::vector<IdentifiedTap> taps;
  analysis::ModesOfTaps found;
};

FoundInTaps looked_at(const analysis::Band& band, std::vector<IdentifiedTap> taps,
                      const std::vector<double>& taken_hz, TapRemarks& remarks) {
  FoundInTaps of{std::move(taps), {}};
  of.found = found_in_parts(band, of.taps, taken_hz, remarks);
  return of;
}

// What had died away by then, but for what of a mode's beginning is no exponential.
std::vector<analysis::RepeatedMode> died_before(double after_s, const analysis::Band& band,
                                                const FoundInTaps& first,
                                                const analysis::ModesOfTaps& later) {
  const std::vector<analysis::FreeDecay> decays = decays_of(first.taps);
  std::vector<analysis::RepeatedMode> modes = analysis::distinct_modes(
      decays, impacts_of(first.taps), band, first.found, rests_of(first.taps));
  analysis::join_resonances(decays, modes);
  return analysis::died_before(after_s, modes, later.modes);
}

// The free part of the taps; what had died away before that.
struct FreeTaps {
  FoundInTaps free;
  std::vector<analysis::RepeatedMode> died;
};

// All sensors of some impacts, spread over the recordings: enough to tell when decays are free.
std::vector<IdentifiedTap> some_of(const std::vector<IdentifiedTap>& taps) {
  constexpr std::size_t enough = 12;
  const std::vector<int> all = impacts_of(taps);
  const std::set<int> different{all.begin(), all.end()};
  const std::size_t apart = different.size() / enough;
  if (apart < 2) {
    return taps;
  }
  std::vector<IdentifiedTap> some;
  std::ranges::copy_if(taps, std::back_inserter(some), [&](const IdentifiedTap& tap) {
    const auto place = std::distance(different.begin(), different.find(tap.impact));
    return static_cast<std::size_t>(place) % apart == 0;
  });
  return some;
}

FreeTaps free_taps(const analysis::Band& band, const std::vector<IdentifiedTap>& taps,
                   const std::vector<double>& taken_hz, TapRemarks& remarks) {
  const std::vector<IdentifiedTap> some = some_of(taps);
  FoundInTaps first = looked_at(band, some, taken_hz, remarks);
  const double settled_s =
      first.taps.empty() ? 0.0
                         : analysis::settled_after_s(decays_of(first.taps), impacts_of(first.taps),
                                                     band, first.found);
  if (settled_s <= 0.0) {
    return {
        some.size() == taps.size() ? std::move(first) : looked_at(band, taps, taken_hz, remarks),
        {}};
  }
  std::vector<IdentifiedTap> later = taps;
  begin_later(settled_s, later, remarks);
  FreeTaps result{looked_at(band, std::move(later), taken_hz, remarks), {}};
  result.died = died_before(settled_s, band, first, result.free.found);
  return result;
}

// Of decays without these tones.
std::vector<analysis::RepeatedMode> modes_beside(const std::vector<analysis::ToneOfTaps>& tones,
                                                 const analysis::Band& band,
                                                 std::vector<IdentifiedTap>& taps,
                                                 analysis::Quantity quantity, TapRemarks& remarks) {
  std::vector<double> taken_hz;
  std::ranges::transform(tones, std::back_inserter(taken_hz), &analysis::ToneOfTaps::frequency_hz);
  FreeTaps ringing = free_taps(band, taps, taken_hz, remarks);
  taps = std::move(ringing.free.taps);
  if (taps.empty()) {
    return {};
  }
  const analysis::ModesOfTaps& found = ringing.free.found;
  std::vector<analysis::RepeatedMode> modes =
      analysis::distinct_modes(decays_of(taps), impacts_of(taps), band, found, rests_of(taps));
  analysis::join_resonances(decays_of(taps), modes);
  if (is_one_impact(taps)) {
    analysis::fit_neighbourhoods(decays_of(taps), band, found.taps, modes);
  }
  analysis::add_died(ringing.died, modes);
  analysis::mark_background(rests_of(taps), modes);
  analysis::tell_of_tones(tones, median_duration_s(taps), modes);
  analysis::judge_certainty(median_duration_s(taps), modes);
  if (is_one_impact(taps)) {
    const auto slow = motion_below(band, taps);
    analysis::judge_single_decay(taps.size(), slow ? slow->peak_hz : 0.0, modes);
  }
  analysis::mark_combinations(modes, derivatives_of(quantity), likeness_over_sensors(taps, modes));
  return modes;
}

// After its quiet stretch does.
double decay_begins_s(const IdentifiedTap& tap) {
  return static_cast<double>(tap.tap.begin) / tap.decay.rate_hz - tap.quiet_s;
}

std::vector<analysis::QuietStretch> stretches_of(const std::vector<IdentifiedTap>& taps) {
  std::vector<analysis::QuietStretch> stretches;
  for (const IdentifiedTap& tap : taps) {
    stretches.push_back({tap.quiet, decay_begins_s(tap), tap.struck_s});
  }
  return stretches;
}

// What is known of them; what is not is fitted.
void take_out(const std::vector<analysis::ToneOfTaps>& tones, std::vector<IdentifiedTap>& taps) {
  for (const analysis::ToneOfTaps& tone : tones) {
    for (std::size_t i = 0; i < taps.size(); ++i) {
      IdentifiedTap& tap = taps[i];
      if (const auto& of_tap = tone.of_taps[i]) {
        analysis::take_tone(*of_tap, decay_begins_s(tap), tap.decay);
        analysis::take_tone(*of_tap, tap.time_s - tap.quiet_s, tap.whole);
      } else {
        tap.beside_hz.push_back(tone.frequency_hz);
      }
    }
  }
}
}  // namespace

namespace {
double peak_of(const IdentifiedTap& tap) {
  return tap.whole.samples.cwiseAbs().maxCoeff();
}

// The hardest tap that the same channel shows.
std::size_t hardest_beside(const IdentifiedTap& tap, const std::vector<IdentifiedTap>& taps) {
  std::size_t hardest = taps.size();
  for (std::size_t i = 0; i < taps.size(); ++i) {
    if (taps[i].channel == tap.channel &&
        (hardest == taps.size() || peak_of(taps[i]) > peak_of(taps[hardest]))) {
      hardest = i;
    }
  }
  return hardest;
}

bool share_a_mode(const std::vector<analysis::FittedMode>& ones,
                  const std::vector<analysis::FittedMode>& others) {
  constexpr double least_share = 0.1;  // of the strongest
  constexpr double same = 0.01;
  double strongest = 0.0;
  for (const analysis::FittedMode& other : others) {
    strongest = std::max(strongest, other.amplitude);
  }
  return std::ranges::any_of(ones, [&](const analysis::FittedMode& one) {
    return std::ranges::any_of(others, [&](const analysis::FittedMode& other) {
      return other.amplitude >= least_share * strongest &&
             std::abs(one.pole.frequency_hz / other.pole.frequency_hz - 1.0) <= same;
    });
  });
}

std::vector<std::vector<analysis::FittedMode>> modes_of_each(
    const analysis::Band& band, const std::vector<IdentifiedTap>& taps) {
  std::vector<std::vector<analysis::FittedMode>> modes(taps.size());
  for (const analysis::Band& of_part : analysis::parts_of(band, decays_of(taps))) {
    TapRemarks unused;
    const PartOfBand part = identified_in(of_part, taps, unused);
    for (std::size_t k = 0; k < part.taps.size(); ++k) {
      for (const analysis::TapMode& mode : part.modes[k].modes) {
        if (mode.standing != analysis::Standing::line) {
          modes[part.taps[k]].push_back(mode.fitted);
        }
      }
    }
  }
  return modes;
}

// What is weak and shares no mode with the hardest tap was no tap of this body: a step nearby, a
// rumble. Unless most are so: then it is the hardest that was none.
void leave_out_strangers(const analysis::Band& band, std::vector<IdentifiedTap>& taps,
                         TapRemarks& remarks) {
  constexpr double weak = 0.2;
  std::vector<std::size_t> hardest;
  std::set<int> weak_impacts = [&] {
    const std::vector<int> all = impacts_of(taps);
    return std::set<int>{all.begin(), all.end()};
  }();
  for (const IdentifiedTap& tap : taps) {
    hardest.push_back(hardest_beside(tap, taps));
    if (peak_of(tap) >= weak * peak_of(taps[hardest.back()])) {
      weak_impacts.erase(tap.impact);
    }
  }
  if (weak_impacts.empty()) {
    return;
  }
  const auto modes = modes_of_each(band, taps);
  std::set<int> strange = weak_impacts;
  for (std::size_t i = 0; i < taps.size(); ++i) {
    if (share_a_mode(modes[i], modes[hardest[i]])) {
      strange.erase(taps[i].impact);
    }
  }
  const std::vector<int> impacts = impacts_of(taps);
  if (2 * strange.size() > std::set<int>{impacts.begin(), impacts.end()}.size()) {
    return;
  }
  for (std::size_t i = 0; i < taps.size(); ++i) {
    if (strange.contains(taps[i].impact)) {
      remarks.add(
          taps[i].file,
          {taps[i].time_s, "left out, it is weak and shares no mode with the hardest tap",
           fmt::format("{:.0f} times weaker", peak_of(taps[hardest[i]]) / peak_of(taps[i]))});
    }
  }
  std::erase_if(taps, [&](const IdentifiedTap& tap) { return strange.contains(tap.impact); });
}
}  // namespace

std::vector<analysis::RepeatedMode> modes_over_all(const analysis::Band& band,
                                                   std::vector<IdentifiedTap>& taps,
                                                   analysis::Quantity quantity,
                                                   TapRemarks& remarks) {
  leave_out_strangers(band, taps, remarks);
  std::vector<IdentifiedTap> as_recorded = taps;
  TapRemarks of_recorded = remarks;
  std::vector<analysis::RepeatedMode> modes = modes_beside({}, band, taps, quantity, of_recorded);
  const std::vector<analysis::ToneOfTaps> tones =
      taps.empty() ? std::vector<analysis::ToneOfTaps>{}
                   : analysis::tones_in(modes, stretches_of(as_recorded), median_duration_s(taps));
  if (tones.empty()) {
    remarks = std::move(of_recorded);
    return modes;
  }
  taps = std::move(as_recorded);
  take_out(tones, taps);
  return modes_beside(tones, band, taps, quantity, remarks);
}
}  // namespace tapstudy::runner
