#include "analysis/modal/decay/decay_band.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/statistics/quantiles.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double beginning_s = 0.01;
constexpr double longer_beginning_s = 0.04;
constexpr double usable_share = 0.47;  // of the rate
constexpr double over_rest = 3.0;
constexpr double strong_share = 0.15;  // of the largest
constexpr double strong_over_rest = 1.5;
constexpr double prominence = 1.5;
constexpr Eigen::Index beside = 6;  // bins within which a peak stands out
constexpr double over_decays = 0.8;
constexpr double first_octave_hz = 1000.0;

// The spectrum's magnitude of samples that are faded out, over the bins from low_hz on.
struct Magnitudes {
  double bin_hz{};
  double first_hz{};
  Eigen::ArrayXd values;
};
Magnitudes magnitudes_of(const Eigen::VectorXd& samples, double rate_hz, double low_hz) {
  const Eigen::Index count = samples.size();
  const Eigen::ArrayXd phase = Eigen::ArrayXd::LinSpaced(count, 0.0, std::numbers::pi / 2.0);
  const FreeDecay faded{rate_hz, (samples.array() * phase.cos().square()).matrix()};
  const BandSpectrum spectrum = band_spectrum(faded, {low_hz, usable_share * rate_hz});
  const double per_rad = rate_hz / (2.0 * std::numbers::pi);
  return {rate_hz / static_cast<double>(spectrum.length), spectrum.rad_per_sample[0] * per_rad,
          spectrum.values.cwiseAbs().array()};
}

bool is_peak(const Eigen::ArrayXd& values, Eigen::Index i) {
  const Eigen::Index first = std::max<Eigen::Index>(0, i - beside);
  const Eigen::Index last = std::min(values.size() - 1, i + beside);
  const Eigen::ArrayXd below = values.segment(first, i - first + 1);
  const Eigen::ArrayXd above = values.segment(i, last - i + 1);
  return values[i] >= values.segment(std::max<Eigen::Index>(0, i - 1), 2).maxCoeff() &&
         values[i] >= above.head(std::min<Eigen::Index>(2, above.size())).maxCoeff() &&
         values[i] > prominence * std::max(below.minCoeff(), above.minCoeff());
}

// By a beginning of this length.
double highest_peak_within(double begin_s, const FreeDecay& decay, double low_hz) {
  const auto count = static_cast<Eigen::Index>(std::lround(begin_s * decay.rate_hz));
  const Magnitudes begin = magnitudes_of(decay.samples.head(count), decay.rate_hz, low_hz);
  const Magnitudes rest = magnitudes_of(decay.samples.tail(count), decay.rate_hz, low_hz);
  const double largest = begin.values.maxCoeff();
  double highest_hz = 0.0;
  for (Eigen::Index i = 0; i < begin.values.size(); ++i) {
    const double value = begin.values[i];
    const double fall = value >= strong_share * largest ? strong_over_rest : over_rest;
    if (value >= weakest_sought * largest && value >= fall * rest.values[i] &&
        is_peak(begin.values, i)) {
      highest_hz = begin.first_hz + static_cast<double>(i + 1) * begin.bin_hz;
    }
  }
  return highest_hz;
}

// Low modes side by side make no peaks of their own in so short a beginning.
double highest_peak_of(const FreeDecay& decay, double low_hz) {
  if (beginning_s * decay.rate_hz < 32.0 || decay.duration_s() < 2.0 * beginning_s) {
    return usable_share * decay.rate_hz;  // too few samples to tell: everything
  }
  const double highest_hz = highest_peak_within(beginning_s, decay, low_hz);
  if (highest_hz > first_octave_hz || decay.duration_s() < 2.0 * longer_beginning_s) {
    return highest_hz;
  }
  const double by_longer_hz = highest_peak_within(longer_beginning_s, decay, low_hz);
  return std::max(highest_hz, std::min(by_longer_hz, first_octave_hz));
}
}  // namespace

double highest_peak_hz(const std::vector<FreeDecay>& decays, double low_hz) {
  std::vector<double> highest_hz;
  for (const FreeDecay& decay : decays) {
    highest_hz.push_back(highest_peak_of(decay, low_hz));
  }
  return quantile(highest_hz, over_decays);
}

double band_end_hz(const std::vector<FreeDecay>& decays, double low_hz) {
  constexpr double least_hz = 100.0;
  constexpr double above_peak = 1.25;
  constexpr double most_outside = 0.5;
  double end_hz = std::max(least_hz, above_peak * highest_peak_hz(decays, low_hz));
  for (;;) {
    const EnergyOutside beyond = energy_outside(decays, {low_hz, end_hz}, low_hz);
    const double further_hz = above_peak * beyond.peak_hz;
    if (beyond.share <= most_outside || further_hz <= end_hz) {
      return end_hz;
    }
    end_hz = further_hz;
  }
}

EnergyOutside energy_outside(const std::vector<FreeDecay>& decays, const Band& band,
                             double low_hz) {
  double all = 0.0;
  double outside = 0.0;
  double most = 0.0;
  EnergyOutside result;
  for (const FreeDecay& decay : decays) {
    const BandSpectrum spectrum = band_spectrum(decay, {low_hz, usable_share * decay.rate_hz});
    const double per_rad = decay.rate_hz / (2.0 * std::numbers::pi);
    const double size = std::max(decay.samples.squaredNorm(), 1e-290);
    for (Eigen::Index k = 0; k < spectrum.values.size(); ++k) {
      const double frequency_hz = spectrum.rad_per_sample[k] * per_rad;
      const double energy = std::norm(spectrum.values[k]) / size;
      all += energy;
      if (!band.holds(frequency_hz)) {
        outside += energy;
        if (energy > most) {
          most = energy;
          result.peak_hz = frequency_hz;
        }
      }
    }
  }
  result.share = all > 0.0 ? outside / all : 0.0;
  return result;
}

namespace {
// Near a frequency the one around which the decays have least energy: a mode on the edge of two
// parts would be found in either, or in both.
double quiet_edge_hz(double near_hz, const std::vector<FreeDecay>& decays) {
  constexpr double reach = 1.08;
  constexpr double around = 1.02;
  constexpr int candidates = 17;
  std::vector<double> energies(candidates, 0.0);
  const auto candidate_hz = [&](std::size_t i) {
    return near_hz * std::pow(reach, 2.0 * static_cast<double>(i) / (candidates - 1) - 1.0);
  };
  const Band near{near_hz / (reach * around), near_hz * reach * around};
  for (const FreeDecay& decay : decays) {
    constexpr double enough_bins = 16.0;
    if (decay.duration_s() * (near.high_hz - near.low_hz) < enough_bins) {
      continue;
    }
    const BandSpectrum spectrum = band_spectrum(decay, near);
    const Eigen::ArrayXd hz = decay.rate_hz / (2.0 * std::numbers::pi) * spectrum.rad_per_sample;
    const Eigen::ArrayXd energy =
        spectrum.values.cwiseAbs2().array() / std::max(decay.samples.squaredNorm(), 1e-290);
    for (std::size_t i = 0; i < energies.size(); ++i) {
      const double at_hz = candidate_hz(i);
      energies[i] += (hz > at_hz / around && hz < at_hz * around).select(energy, 0.0).sum() / at_hz;
    }
  }
  const auto least = std::ranges::min_element(energies);
  return candidate_hz(static_cast<std::size_t>(least - energies.begin()));
}
}  // namespace

std::vector<Band> parts_of(const Band& band, const std::vector<FreeDecay>& decays) {
  constexpr double ratio = std::numbers::sqrt2;
  std::vector<Band> parts;
  double low_hz = band.low_hz;
  for (double edge_hz = first_octave_hz; 1.25 * edge_hz < band.high_hz; edge_hz *= ratio) {
    if (edge_hz > 1.25 * low_hz) {
      parts.push_back({low_hz, quiet_edge_hz(edge_hz, decays)});
      low_hz = parts.back().high_hz;
    }
  }
  parts.push_back({low_hz, band.high_hz});
  return parts;
}

namespace {
constexpr double chunk_s = 0.05;
constexpr Eigen::Index chunks_at_rest = 3;
constexpr double over_chunks_at_rest = 30.0;  // of power: noise hardly exceeds it by chance

Eigen::ArrayXd power_of(const FreeDecay& decay, const Band& band, Eigen::Index first,
                        Eigen::Index count) {
  return band_spectrum({decay.rate_hz, decay.samples.segment(first, count)}, band)
      .values.cwiseAbs2()
      .array();
}

// Where the part's last mode has died away in what is left at the decay's end. A narrow part is
// looked at with its surroundings, in chunks that are long enough to hold bins of them.
Eigen::Index rung_until(const Band& part, const FreeDecay& decay) {
  constexpr double surroundings = 1.25;
  constexpr double bins = 12.0;
  const Band seen{part.low_hz / surroundings,
                  std::min(usable_share * decay.rate_hz, surroundings * part.high_hz)};
  const double longest_s = std::max(chunk_s, bins / (seen.high_hz - seen.low_hz));
  const auto count = static_cast<Eigen::Index>(std::lround(longest_s * decay.rate_hz));
  const Eigen::Index chunks = decay.samples.size() / std::max<Eigen::Index>(count, 1);
  if (chunks < 2 * chunks_at_rest) {
    return decay.samples.size();
  }
  Eigen::ArrayXd rest = power_of(decay, seen, (chunks - 1) * count, count);
  for (Eigen::Index i = 2; i <= chunks_at_rest; ++i) {
    rest += power_of(decay, seen, (chunks - i) * count, count);
  }
  rest = (rest / static_cast<double>(chunks_at_rest)).max(1e-290);
  Eigen::Index last = chunks - chunks_at_rest;
  while (last > 1 && (power_of(decay, seen, (last - 1) * count, count) / rest).maxCoeff() <
                         over_chunks_at_rest) {
    --last;
  }
  return std::min(decay.samples.size(), (last + 2) * count);
}
}  // namespace

FreeDecay shortened_for(const Band& part, const FreeDecay& decay) {
  const double periods_s =
      part.low_hz < first_octave_hz ? decay.duration_s() : first_octave_hz / part.low_hz;
  const auto longest = static_cast<Eigen::Index>(std::ceil(periods_s * decay.rate_hz));
  return {decay.rate_hz, decay.samples.head(std::min(longest, rung_until(part, decay)))};
}
}  // namespace tapstudy::analysis
