#include "analysis/modal/recording/sustained_sound.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/modal/decay/free_decay.hpp"
#include "analysis/statistics/quantiles.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double least_sound_rate_hz = 2000.0;
constexpr double averaged_rate_hz = 8000.0;
constexpr double short_frame_s = 0.01;
constexpr double long_frame_s = 0.05;
constexpr double first_energy_s = 0.04;
constexpr double later_energy_s = 0.06;
constexpr double swell = 1.5;         // of the energy so far
constexpr double fallen = 1.0 / 3.0;  // likewise
constexpr double loud_again = 0.5;    // likewise
constexpr double above_floor = 10.0;  // likewise
constexpr double same_tone = 0.03;    // of the frequency, to either side
constexpr double most_components = 0.75;
constexpr double lowest_tone_hz = 60.0;

// Differences between samples of about 8 kHz: neither slow movement nor hiss counts.
class Differences {
 public:
  explicit Differences(const Recording& recording)
      : factor_{std::max<std::size_t>(
            1, static_cast<std::size_t>(recording.rate_hz / averaged_rate_hz))},
        rate_hz_{recording.rate_hz / static_cast<double>(factor_)},
        values_(static_cast<Eigen::Index>(recording.samples.size() / factor_)) {
    double before = 0.0;
    for (Eigen::Index i = 0; i < values_.size(); ++i) {
      double mean = 0.0;
      for (std::size_t k = 0; k < factor_; ++k) {
        mean += recording.samples[static_cast<std::size_t>(i) * factor_ + k];
      }
      mean /= static_cast<double>(factor_);
      values_[i] = i == 0 ? 0.0 : mean - before;
      before = mean;
    }
    std::vector<double> energies;
    for (Eigen::Index i = 0; i + samples(short_frame_s) <= values_.size();
         i += samples(short_frame_s)) {
      energies.push_back(energy(i, short_frame_s));
    }
    floor_ = energies.empty() ? 0.0 : quantile(energies, 0.2);
  }

  Eigen::Index place(std::size_t sample) const {
    return static_cast<Eigen::Index>(sample / factor_);
  }
  Eigen::Index size() const { return values_.size(); }
  Eigen::Index samples(double seconds) const {
    return static_cast<Eigen::Index>(std::lround(seconds * rate_hz_));
  }
  double energy(Eigen::Index first, double seconds) const {
    return values_.segment(first, samples(seconds)).squaredNorm() /
           static_cast<double>(samples(seconds));
  }
  // How often a sound becomes louder than its beginning, or as loud again as it was.
  int swells(Eigen::Index onset, Eigen::Index end) const {
    const Eigen::Index frame = samples(short_frame_s);
    double loudest = 0.0;
    Eigen::Index i = onset;
    for (; i + frame <= std::min(end, onset + samples(first_energy_s)); i += frame) {
      loudest = std::max(loudest, energy(i, short_frame_s));
    }
    int count = 0;
    bool has_fallen = false;
    for (; i + frame <= end; i += frame) {
      const double now = energy(i, short_frame_s);
      const bool is_louder = count == 0 && now > swell * loudest;
      const bool is_back = has_fallen && now > loud_again * loudest;
      if ((is_louder || is_back) && !is_silent(now)) {
        ++count;
        has_fallen = false;
      }
      has_fallen = has_fallen || now < fallen * loudest;
      loudest = std::max(loudest, now);
    }
    return count;
  }
  bool is_silent(double energy) const { return energy < above_floor * floor_; }

  // The frequency of the largest value of the spectrum, by a parabola.
  double strongest_hz(Eigen::Index first) const {
    const Eigen::Index count = samples(long_frame_s);
    const Eigen::ArrayXd window =
        (Eigen::ArrayXd::LinSpaced(count, 0.0, 2.0 * std::numbers::pi)).unaryExpr([](double phase) {
          return 1.0 - std::cos(phase);
        });
    const BandSpectrum spectrum =
        band_spectrum({rate_hz_, (values_.segment(first, count).array() * window).matrix()},
                      {lowest_tone_hz, 0.47 * rate_hz_});
    const Eigen::ArrayXd size = spectrum.values.cwiseAbs().array();
    Eigen::Index at = 0;
    size.maxCoeff(&at);
    const double bin = static_cast<double>(at) + vertex_beside(size, at);
    const double first_hz = spectrum.rad_per_sample[0] * rate_hz_ / (2.0 * std::numbers::pi);
    return first_hz + bin * rate_hz_ / static_cast<double>(spectrum.length);
  }

 private:
  static double vertex_beside(const Eigen::ArrayXd& size, Eigen::Index at) {
    if (at == 0 || at + 1 == size.size()) {
      return 0.0;
    }
    const double bend = size[at - 1] - 2.0 * size[at] + size[at + 1];
    return bend < 0.0 ? 0.5 * (size[at - 1] - size[at + 1]) / bend : 0.0;
  }

  std::size_t factor_;
  double rate_hz_;
  Eigen::VectorXd values_;
  double floor_{};
};

// How many intervals of one tone hold most of these frequencies.
int tones_among(std::vector<double> frequencies_hz) {
  std::ranges::sort(frequencies_hz);
  const auto enough = static_cast<std::size_t>(
      std::ceil(most_components * static_cast<double>(frequencies_hz.size())));
  const std::size_t spare = frequencies_hz.size() - enough;
  int tones = 0;
  while (frequencies_hz.size() > spare) {
    auto most_begin = frequencies_hz.begin();
    auto most_end = frequencies_hz.begin();
    for (auto begin = frequencies_hz.begin(); begin != frequencies_hz.end(); ++begin) {
      const auto end =
          std::upper_bound(begin, frequencies_hz.end(), *begin * (1.0 + 2.0 * same_tone));
      if (end - begin > most_end - most_begin) {
        most_begin = begin;
        most_end = end;
      }
    }
    frequencies_hz.erase(most_begin, most_end);
    ++tones;
  }
  return tones;
}
}  // namespace

bool SustainedSound::is_sustained() const {
  constexpr int many_tones = 5;
  constexpr int fewest_swells = 2;
  constexpr int least_share = 8;  // one of so many
  return tones >= many_tones && swells >= fewest_swells && least_share * swells >= judged;
}

SustainedSound sustained_sound(const Recording& recording, const std::vector<Impact>& impacts) {
  SustainedSound sound;
  if (recording.rate_hz < least_sound_rate_hz) {
    return sound;
  }
  const Differences differences{recording};
  std::vector<double> strongest_hz;
  for (std::size_t k = 0; k < impacts.size(); ++k) {
    const Eigen::Index onset = differences.place(impacts[k].last_blow);
    const Eigen::Index next =
        k + 1 < impacts.size() ? differences.place(impacts[k + 1].onset) : differences.size();
    if (onset + differences.samples(later_energy_s) > next) {
      continue;
    }
    ++sound.judged;
    sound.swells += differences.swells(onset, next);
    for (Eigen::Index at = onset + differences.samples(first_energy_s);
         at + differences.samples(long_frame_s) <= next;
         at += differences.samples(long_frame_s) / 2) {
      if (!differences.is_silent(differences.energy(at, long_frame_s))) {
        strongest_hz.push_back(differences.strongest_hz(at));
      }
    }
  }
  sound.tones = tones_among(std::move(strongest_hz));
  return sound;
}
}  // namespace tapstudy::analysis
