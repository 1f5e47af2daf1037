#include "analysis/recordings/taps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/recordings/innovation.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double frame_s = 0.002;
constexpr std::size_t min_frame = 8;
constexpr std::size_t frames_per_group = 10;
constexpr std::size_t frames_before = 5;
constexpr double onset_ratio = 10.0;
constexpr double rise_ratio = 2.0;
constexpr double end_ratio = 2.0;
constexpr double envelope_s = 0.05;
constexpr double surprise_ratio = 4.0;
constexpr std::size_t settled_frames = 6;
constexpr std::size_t look_back_frames = 125;
constexpr double one_impact_s = 0.03;
constexpr double peak_search_s = 0.01;
constexpr std::size_t min_decay = 64;
constexpr double min_decay_s = 0.02;

std::size_t samples_in(double seconds, double rate_hz) {
  return static_cast<std::size_t>(std::llround(seconds * rate_hz));
}

// Mean squares about the median, frame after frame.
struct Energies {
  std::size_t frame{};  // samples
  std::vector<double> of_frame;
  std::vector<double> innovations;  // likewise, see innovation_energies
  double floor{};

  double of_group(std::size_t first) const {
    const std::size_t count = std::min(frames_per_group, of_frame.size() - first);
    const auto begin = of_frame.begin() + static_cast<std::ptrdiff_t>(first);
    return std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(count), 0.0) /
           static_cast<double>(count);
  }
};

Energies energies_of(const std::vector<double>& centred, double rate_hz) {
  Energies energies{std::max(min_frame, samples_in(frame_s, rate_hz)), {}, {}, 0.0};
  for (std::size_t i = 0; i + energies.frame <= centred.size(); i += energies.frame) {
    double sum = 0.0;
    for (std::size_t k = i; k < i + energies.frame; ++k) {
      sum += centred[k] * centred[k];
    }
    energies.of_frame.push_back(sum / static_cast<double>(energies.frame));
  }
  energies.innovations = innovation_energies(centred, rate_hz, energies.frame);
  std::vector<double> groups;
  for (std::size_t i = 0; i < energies.of_frame.size(); i += frames_per_group) {
    groups.push_back(energies.of_group(i));
  }
  const double loudest = *std::ranges::max_element(energies.of_frame);
  energies.floor = std::max(quantile(groups, 0.2), 1e-12 * loudest);
  return energies;
}

// Modes that beat, and slow ones, rise again and again while they ring: an impact is also not what
// the motion before foretells.
bool is_surprising(std::size_t frame, std::size_t last_impact, const Energies& energies) {
  const std::size_t first = std::max(last_impact + settled_frames,
                                     frame > look_back_frames ? frame - look_back_frames : 0);
  if (first + 2 > frame) {
    return true;
  }
  const auto at = [&](std::size_t i) {
    return energies.innovations.begin() + static_cast<std::ptrdiff_t>(i);
  };
  const std::vector<double> before(at(first), at(frame - 1));
  const std::size_t end = std::min(frame + 2, energies.innovations.size());
  const double now = *std::max_element(at(frame - 1), at(end));
  return now > surprise_ratio * quantile(before, 0.8);
}

std::vector<std::size_t> frames_of_impacts(const Energies& energies, double rate_hz) {
  const double frame_duration_s = static_cast<double>(energies.frame) / rate_hz;
  const double fall = std::exp(-frame_duration_s / envelope_s);
  const auto one_impact = static_cast<std::size_t>(std::ceil(one_impact_s / frame_duration_s));
  std::vector<std::size_t> impacts;
  double envelope = 0.0;
  for (std::size_t j = 0; j < energies.of_frame.size(); ++j) {
    const double energy = energies.of_frame[j];
    const bool is_new = impacts.empty() || j - impacts.back() > one_impact;
    if (is_new && energy > onset_ratio * energies.floor && energy > rise_ratio * envelope &&
        (impacts.empty() || is_surprising(j, impacts.back(), energies))) {
      impacts.push_back(j);
    }
    envelope = std::max(energy, fall * envelope);
  }
  return impacts;
}

// The first sample above the noise and above what rang in the frames before, from where on the
// energy stays above the noise: single samples of noise exceed it by chance.
std::size_t onset_near(std::size_t frame, const Energies& energies,
                       const std::vector<double>& centred) {
  const std::size_t first = (frame > 0 ? frame - 1 : 0) * energies.frame;
  const std::size_t before = frames_before * energies.frame;
  double limit = std::sqrt(onset_ratio * energies.floor);
  for (std::size_t i = first > before ? first - before : 0; i < first; ++i) {
    limit = std::max(limit, std::abs(centred[i]));
  }
  std::size_t i = first;
  const std::size_t end = (frame + 1) * energies.frame;
  const auto stays = [&](std::size_t from) {
    const std::size_t to = std::min(from + energies.frame, centred.size());
    double sum = 0.0;
    for (std::size_t k = from; k < to; ++k) {
      sum += centred[k] * centred[k];
    }
    return sum > onset_ratio / 2.0 * energies.floor * static_cast<double>(to - from);
  };
  while (i + 1 < end && (std::abs(centred[i]) <= limit || !stays(i))) {
    ++i;
  }
  return i;
}

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

class TapFinder {
 public:
  TapFinder(const Recording& recording, const TapFinding& finding)
      : recording_{recording},
        finding_{finding},
        centred_{recording.samples},
        rails_{rail_samples(recording.samples)} {
    const double middle = quantile(recording.samples, 0.5);
    for (double& sample : centred_) {
      sample -= middle;
    }
    energies_ = energies_of(centred_, recording.rate_hz);
  }

  std::vector<std::size_t> onsets() const {
    std::vector<std::size_t> found;
    for (const std::size_t frame : frames_of_impacts(energies_, recording_.rate_hz)) {
      found.push_back(onset_near(frame, energies_, centred_));
    }
    if (found.empty()) {
      throw core::InvalidInput{refusal(0)};
    }
    return found;
  }

  FoundTaps find(const std::vector<std::size_t>& onsets) {
    found_.noise_rms = std::sqrt(energies_.floor);
    found_.impacts = static_cast<int>(onsets.size());
    for (std::size_t k = 0; k < onsets.size(); ++k) {
      impact_ = static_cast<int>(k) + 1;
      add(onsets[k], k + 1 < onsets.size() ? onsets[k + 1] : centred_.size(),
          k + 1 < onsets.size());
    }
    if (found_.taps.empty()) {
      throw core::InvalidInput{refusal(onsets.size())};
    }
    return std::move(found_);
  }

 private:
  std::string at(std::size_t onset) const {
    return fmt::format("the tap at {:.3f} s", static_cast<double>(onset) / recording_.rate_hz);
  }

  std::size_t begin_of_decay(std::size_t onset, std::size_t last) {
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
      found_.remarks.push_back(
          fmt::format("{} is clipped: its decay is taken from {:.4f} s on, after the last sample "
                      "at the limit",
                      at(onset), static_cast<double>(begin) / recording_.rate_hz));
    }
    return begin;
  }

  void add(std::size_t onset, std::size_t next, bool is_followed) {
    const std::size_t guard = is_followed ? energies_.frame : 0;
    const std::size_t last = next > onset + guard ? next - guard : onset;
    const std::size_t begin = begin_of_decay(onset, last);
    const std::size_t longest = begin + samples_in(finding_.max_s, recording_.rate_hz);
    const std::size_t end =
        begin < last ? std::min(longest, end_of_decay(energies_, begin, last)) : begin;
    const double decay_s = static_cast<double>(end - begin) / recording_.rate_hz;
    if (end - begin < min_decay || decay_s < min_decay_s) {
      found_.remarks.push_back(fmt::format(
          "{} is left out: it rings for {} samples, {:.3f} s, until the {} (at least {}, {} s)",
          at(onset), end - begin, decay_s, end == last && is_followed ? "next tap" : "noise",
          min_decay, min_decay_s));
      return;
    }
    if (end == last && is_followed) {
      found_.remarks.push_back(
          fmt::format("{} is cut at the next one, after {:.3f} s", at(onset), decay_s));
    }
    found_.taps.push_back({impact_, onset, begin, end});
  }

  std::string refusal(std::size_t impacts) const {
    const double loudest = *std::ranges::max_element(energies_.of_frame);
    if (!(loudest > 0.0)) {
      return recording_.file + ": holds no tap: all samples are the same";
    }
    if (impacts == 0) {
      return fmt::format(
          "{}: holds no tap: nowhere does the energy exceed the noise floor tenfold (at most "
          "{:.1f} times)",
          recording_.file, loudest / energies_.floor);
    }
    return fmt::format("{}: holds no tap that can be used: {}", recording_.file,
                       fmt::join(found_.remarks, "; "));
  }

  const Recording& recording_;
  TapFinding finding_;
  std::vector<double> centred_;
  std::vector<std::size_t> rails_;
  Energies energies_;
  FoundTaps found_;
  int impact_{0};
};
}  // namespace

namespace {
void check_length(const Recording& recording) {
  if (recording.samples.size() < min_samples) {
    throw core::InvalidInput{fmt::format("{}: has {} samples (at least {})", recording.file,
                                         recording.samples.size(), min_samples)};
  }
}
}  // namespace

FoundTaps find_taps(const Recording& recording, const TapFinding& finding) {
  return taps_at(impact_onsets(recording), recording, finding);
}

FoundTaps taps_at(const std::vector<std::size_t>& onsets, const Recording& recording,
                  const TapFinding& finding) {
  check_length(recording);
  return TapFinder{recording, finding}.find(onsets);
}

std::vector<std::size_t> impact_onsets(const Recording& recording) {
  check_length(recording);
  return TapFinder{recording, {}}.onsets();
}
}  // namespace tapstudy::analysis
