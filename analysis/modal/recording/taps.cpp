#include "analysis/modal/recording/taps.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "analysis/modal/recording/impact_search.hpp"
#include "analysis/modal/recording/sustained_sound.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double end_ratio = 2.0;
constexpr double peak_search_s = 0.01;
constexpr std::size_t min_decay = 64;
constexpr double min_decay_s = 0.02;
constexpr double weaker_than_most = 30.0;

std::size_t end_of_decay(const Energies& energies, std::size_t begin, std::size_t last) {
  for (std::size_t j = begin / energies.frame + 1; j < energies.of_frame.size();
       j += frames_per_group) {
    if (j * energies.frame >= last) {
      break;
    }
    if (energies.of_group(j) < end_ratio * energies.floor) {
      return std::min(last, (j + frames_per_group) * energies.frame);
    }
  }
  return last;
}

std::vector<double> without(double offset, std::vector<double> samples) {
  for (double& sample : samples) {
    sample -= offset;
  }
  return samples;
}

class TapFinder {
 public:
  TapFinder(const Recording& recording, const TapFinding& finding)
      : recording_{recording},
        finding_{finding},
        centred_{without(quantile(recording.samples, 0.5), recording.samples)},
        energies_{energies_of(centred_, recording.rate_hz)},
        rails_{rail_samples(recording.samples, noise_rms())},
        dropped_{dropped_samples(recording.samples, noise_rms())} {}

  // Impacts that this sensor shows: what is far weaker than most of them is none.
  FoundTaps find_own() {
    const std::vector<Impact> found = impacts();
    std::vector<double> peaks;
    std::ranges::transform(found, std::back_inserter(peaks),
                           [&](const Impact& impact) { return peak_after(impact); });
    least_peak_ = quantile(peaks, 0.5) / weaker_than_most;
    return find(found);
  }

  double noise_rms() const { return std::sqrt(energies_.floor); }

  std::vector<Impact> impacts() const {
    std::vector<Impact> found = sensor_impacts(energies_, centred_, recording_.rate_hz);
    std::erase_if(found, [&](const Impact& impact) { return is_after_gap(impact); });
    if (found.empty()) {
      throw core::InvalidInput{refusal(0)};
    }
    refuse_sustained(sustained_sound(recording_, found));
    return found;
  }

  // Refuses what holds nothing but noise.
  std::vector<Impact> pulses() const {
    static_cast<void>(impacts());
    return force_pulses(centred_, noise_rms(), recording_.rate_hz);
  }

  FoundTaps find(const std::vector<Impact>& impacts) {
    found_.noise_rms = noise_rms();
    found_.impacts = static_cast<int>(impacts.size());
    for (std::size_t k = 0; k < impacts.size(); ++k) {
      impact_ = static_cast<int>(k) + 1;
      add(impacts[k], k + 1 < impacts.size() ? impacts[k + 1].onset : centred_.size(),
          k + 1 < impacts.size());
    }
    if (found_.taps.empty()) {
      throw core::InvalidInput{refusal(impacts.size())};
    }
    return std::move(found_);
  }

 private:
  void remark(std::size_t onset, std::string kind, std::string detail) {
    found_.remarks.push_back(
        {static_cast<double>(onset) / recording_.rate_hz, std::move(kind), std::move(detail)});
  }

  double energy_between(std::size_t begin, std::size_t end) const {
    double sum = 0.0;
    for (std::size_t i = begin; i < std::min(end, centred_.size()); ++i) {
      sum += centred_[i] * centred_[i];
    }
    return sum;
  }

  // Whether a vibration only goes on there after dropped samples: a blow would give it energy.
  bool is_after_gap(const Impact& impact) const {
    constexpr double rises = 2.0;
    const std::size_t reach = 2 * energies_.frame;
    const auto first =
        std::ranges::lower_bound(dropped_, impact.onset - std::min(impact.onset, reach));
    if (first == dropped_.end() || *first > impact.onset + reach) {
      return false;
    }
    auto last = first;
    while (last + 1 != dropped_.end() && *(last + 1) == *last + 1) {
      ++last;
    }
    const std::size_t around = frames_per_group * energies_.frame;
    return energy_between(*last + 1, *last + 1 + around) <
           rises * energy_between(*first - std::min(*first, around), *first);
  }

  double peak_after(const Impact& impact) const {
    double peak = 0.0;
    const std::size_t end =
        std::min(centred_.size(), impact.onset + samples_in(peak_search_s, recording_.rate_hz) + 1);
    for (std::size_t i = impact.onset; i < end; ++i) {
      peak = std::max(peak, std::abs(centred_[i]));
    }
    return peak;
  }

  std::size_t begin_of_decay(const Impact& impact, std::size_t last) {
    const std::size_t onset = impact.last_blow;
    if (onset != impact.onset) {
      remark(
          impact.onset,
          "struck again within 30 ms: its decay is taken from there on, and no decaying sinusoid "
          "is fitted to it",
          fmt::format("{:.4f} s later",
                      static_cast<double>(onset - impact.onset) / recording_.rate_hz));
    }
    const auto magnitude = [&](std::size_t i) { return std::abs(centred_[i]); };
    std::size_t peak = onset;
    const std::size_t search =
        std::min(last, onset + samples_in(peak_search_s, recording_.rate_hz) + 1);
    for (std::size_t i = onset; i < search; ++i) {
      peak = magnitude(i) > magnitude(peak) ? i : peak;
    }
    const std::size_t skip =
        std::max<std::size_t>(1, samples_in(finding_.skip_s, recording_.rate_hz));
    std::size_t begin = peak + skip;
    const auto railed_end = std::ranges::lower_bound(rails_, last);
    if (railed_end != rails_.begin() && *(railed_end - 1) >= onset) {
      begin = std::max(begin, *(railed_end - 1) + 1);
      remark(impact.onset,
             "clipped: its decay is taken from the last sample at the limit on, and no decaying "
             "sinusoid "
             "is fitted to it",
             fmt::format("at {:.4f} s", static_cast<double>(begin) / recording_.rate_hz));
    }
    return begin;
  }

  void add(const Impact& impact, std::size_t next, bool is_followed) {
    const std::size_t onset = impact.onset;
    if (const double peak = peak_after(impact); peak < least_peak_) {
      remark(onset, "left out, it is far weaker than most: a click or a step, and no tap",
             fmt::format("{:.0f} times", least_peak_ * weaker_than_most / peak));
      return;
    }
    const std::size_t guard = is_followed ? energies_.frame : 0;
    const std::size_t last = next > onset + guard ? next - guard : onset;
    const std::size_t begin = begin_of_decay(impact, last);
    const std::size_t longest = begin + samples_in(finding_.max_s, recording_.rate_hz);
    const std::size_t rings_until = begin < last ? end_of_decay(energies_, begin, last) : begin;
    const std::size_t end = std::min(longest, rings_until);
    const double decay_s = static_cast<double>(end - begin) / recording_.rate_hz;
    if (end - begin < min_decay || decay_s < min_decay_s) {
      remark(onset,
             fmt::format("left out, it rings for fewer than {} samples or {} s", min_decay,
                         min_decay_s),
             fmt::format("{} samples, {:.3f} s, until the {}", end - begin, decay_s,
                         end == last && is_followed ? "next tap" : "noise"));
      return;
    }
    if (end == last && is_followed) {
      remark(onset, "cut at the next one", fmt::format("after {:.3f} s", decay_s));
    } else if (end < rings_until) {
      remark(onset, fmt::format("cut after {:g} s, while it rings (--longest)", finding_.max_s),
             fmt::format("until {:.3g} s",
                         static_cast<double>(rings_until - begin) / recording_.rate_hz));
    }
    found_.taps.push_back({impact_, onset, begin, end, impact.last_blow != onset});
  }

  void refuse_sustained(const SustainedSound& sound) const {
    if (sound.is_sustained()) {
      throw core::InvalidInput{
          fmt::format("{}: holds no taps but speech, music or the like: after {} beginnings its "
                      "sounds swell {} "
                      "times, and they have {} different pitches",
                      recording_.file, sound.judged, sound.swells, sound.tones)};
    }
  }

  std::string refusal(std::size_t impacts) const {
    const double loudest = *std::ranges::max_element(energies_.of_frame);
    if (!(loudest > 0.0)) {
      return recording_.file + ": holds no tap: all samples are the same";
    }
    constexpr double tenfold = 10.0;
    if (impacts == 0 && loudest >= tenfold * energies_.floor) {
      return fmt::format(
          "{}: holds no tap: its energy reaches {:.0f} times the noise floor, but nowhere as "
          "suddenly as after an impact",
          recording_.file, loudest / energies_.floor);
    }
    if (impacts == 0) {
      return fmt::format(
          "{}: holds no tap: nowhere does the energy exceed the noise floor tenfold (at most "
          "{:.1f} times; a plate that never falls silent between taps looks like that, too: leave "
          "more time between them)",
          recording_.file, loudest / energies_.floor);
    }
    std::vector<std::string> sentences;
    std::ranges::transform(found_.remarks, std::back_inserter(sentences), sentence);
    return fmt::format("{}: holds no tap that can be used: {}", recording_.file,
                       fmt::join(sentences, "; "));
  }

  const Recording& recording_;
  TapFinding finding_;
  std::vector<double> centred_;
  Energies energies_;
  std::vector<std::size_t> rails_;
  std::vector<std::size_t> dropped_;
  FoundTaps found_;
  int impact_{0};
  double least_peak_{0.0};
};
}  // namespace

std::string sentence(const TapRemark& remark) {
  return fmt::format("the tap at {:.3f} s: {}{}{}", remark.at_s, remark.kind,
                     remark.detail.empty() ? "" : ", ", remark.detail);
}

namespace {
void check_length(const Recording& recording) {
  if (recording.samples.size() < min_samples) {
    throw core::InvalidInput{fmt::format("{}: has {} samples (at least {})", recording.file,
                                         recording.samples.size(), min_samples)};
  }
  const std::size_t least = frames_per_group * frame_of(recording.rate_hz);
  if (recording.samples.size() < least) {
    throw core::InvalidInput{
        fmt::format("{}: has {} samples at {:g} Hz, {:.3g} s (at least {:.3g} s)", recording.file,
                    recording.samples.size(), recording.rate_hz,
                    static_cast<double>(recording.samples.size()) / recording.rate_hz,
                    static_cast<double>(least) / recording.rate_hz)};
  }
}
}  // namespace

FoundTaps find_taps(const Recording& recording, const TapFinding& finding) {
  check_length(recording);
  TapFinder finder{recording, finding};
  return finder.find_own();
}

FoundTaps taps_at(const std::vector<Impact>& impacts, const Recording& recording,
                  const TapFinding& finding) {
  check_length(recording);
  return TapFinder{recording, finding}.find(impacts);
}

std::vector<Impact> force_impacts(const Recording& force) {
  check_length(force);
  return TapFinder{force, {}}.pulses();
}

Resting resting(const Recording& recording) {
  check_length(recording);
  const double value = quantile(recording.samples, 0.5);
  return {value,
          std::sqrt(energies_of(without(value, recording.samples), recording.rate_hz).floor)};
}

bool shows(const Tap& tap, const Recording& recording, const Resting& at_rest) {
  constexpr double tenfold = 10.0;
  const std::size_t frame = frame_of(recording.rate_hz);
  const double least = tenfold * at_rest.noise_rms * at_rest.noise_rms;
  for (std::size_t begin = tap.onset; begin + frame <= tap.end; begin += frame) {
    double energy = 0.0;
    for (std::size_t i = begin; i < begin + frame; ++i) {
      const double value = recording.samples[i] - at_rest.value;
      energy += value * value / static_cast<double>(frame);
    }
    if (energy >= least) {
      return true;
    }
  }
  return false;
}

namespace {
constexpr std::size_t min_run = 3;
constexpr double smooth_steps = 3.0;
constexpr std::size_t min_noisy_run = 4;
constexpr double noise_tolerance = 3.0;
constexpr double limited_steps = 6.0;

// The least difference between successive samples, 0 if all are equal.
double resolution_of(const std::vector<double>& samples) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double step = std::abs(samples[i] - samples[i - 1]);
    if (step > 0.0) {
      least = std::min(least, step);
    }
  }
  return std::isfinite(least) ? least : 0.0;
}

// The larger step of the signal at the two ends of a run.
double step_beside(const std::vector<double>& samples, std::size_t begin, std::size_t end) {
  const double before = begin > 0 ? std::abs(samples[begin - 1] - samples[begin]) : 0.0;
  const double after = end < samples.size() ? std::abs(samples[end] - samples[begin]) : 0.0;
  return std::max(before, after);
}

// Runs within a tolerance of the extreme; is_rail gets the run's end points.
template <class IsRail>
void add_runs_at(double extreme, double tolerance, const std::vector<double>& samples,
                 IsRail is_rail, std::vector<std::size_t>& rails) {
  for (std::size_t i = 0; i < samples.size();) {
    std::size_t end = i;
    while (end < samples.size() && std::abs(samples[end] - extreme) <= tolerance) {
      ++end;
    }
    if (end > i && is_rail(i, end)) {
      rails.resize(rails.size() + end - i);
      std::iota(rails.end() - static_cast<std::ptrdiff_t>(end - i), rails.end(), i);
    }
    i = std::max(end, i + 1);
  }
}

double spread_of(const std::vector<double>& samples, std::size_t begin, std::size_t end) {
  const auto at = [&](std::size_t i) { return samples.begin() + static_cast<std::ptrdiff_t>(i); };
  const auto [low, high] = std::minmax_element(at(begin), at(end));
  return *high - *low;
}
}  // namespace

std::vector<std::size_t> rail_samples(const std::vector<double>& samples, double noise_rms) {
  std::vector<std::size_t> rails;
  if (samples.empty()) {
    return rails;
  }
  const auto [low, high] = std::ranges::minmax(samples);
  if (low == high) {
    return rails;
  }
  const double resolution = resolution_of(samples);
  const auto is_flat = [&](std::size_t begin, std::size_t end) {
    return end - begin >= min_run && step_beside(samples, begin, end) > smooth_steps * resolution;
  };
  // A smooth peak moves at the end of the run by at most three times what it does within it.
  const auto is_limited = [&](std::size_t begin, std::size_t end) {
    return end - begin >= min_noisy_run &&
           step_beside(samples, begin, end) >
               limited_steps * std::max({spread_of(samples, begin, end), resolution, noise_rms});
  };
  for (const double extreme : {low, high}) {
    add_runs_at(extreme, 0.0, samples, is_flat, rails);
    add_runs_at(extreme, noise_tolerance * noise_rms, samples, is_limited, rails);
  }
  std::ranges::sort(rails);
  rails.erase(std::unique(rails.begin(), rails.end()), rails.end());
  return rails;
}

std::vector<std::size_t> dropped_samples(const std::vector<double>& samples, double noise_rms) {
  constexpr std::size_t min_dropped = 4;
  std::vector<std::size_t> dropped;
  const double least = limited_steps * std::max(resolution_of(samples), noise_rms);
  const auto is_gap = [&](std::size_t begin, std::size_t end) {
    return end - begin >= min_dropped && begin > 0 && end < samples.size() &&
           std::abs(samples[begin - 1]) > least && std::abs(samples[end]) > least;
  };
  add_runs_at(0.0, 0.0, samples, is_gap, dropped);
  return dropped;
}
}  // namespace tapstudy::analysis
