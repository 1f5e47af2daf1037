#include "analysis/modal/modes/one_resonance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "analysis/modal/decay/decay_band.hpp"
#include "analysis/modal/decay/decay_model.hpp"
#include "analysis/modal/modes/distinct_modes.hpp"
#include "analysis/modal/modes/mode_shapes.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double weak_beside = 0.2;  // 14 dB
constexpr double remainder_reach = 0.15;
constexpr double around_bandwidths = 8.0;
constexpr double around_share = 0.04;
constexpr double least_bins_around = 24.0;

double frequency_hz_of(const RepeatedMode& mode) {
  return mode.frequency_hz.value;
}
double halfwidth_hz(const RepeatedMode& mode) {
  return mode.damping_ratio.value * frequency_hz_of(mode);
}
double decay_rate_of(const RepeatedMode& mode) {
  return 2.0 * std::numbers::pi * halfwidth_hz(mode);
}

bool may_be_part(const RepeatedMode& mode) {
  return (mode.standing == Standing::agreed || mode.standing == Standing::doubtful) &&
         mode.damping_ratio.value > 0.0;
}

// What of a strong mode's beginning is no exponential, by reflections of the blow or as it follows
// its amplitude, is weak, dies away sooner and lies beside it.
bool is_remainder(const RepeatedMode& part, const RepeatedMode& of) {
  return part.amplitude < weak_beside * of.amplitude && decay_rate_of(part) > decay_rate_of(of) &&
         std::abs(frequency_hz_of(part) - frequency_hz_of(of)) <
             remainder_reach * frequency_hz_of(of);
}

// What dies away within a blow and its reflections is as wide as they make it.
bool overlap(const RepeatedMode& a, const RepeatedMode& b) {
  if (is_remainder(a, b) || is_remainder(b, a)) {
    return true;
  }
  const bool is_short = blow_s * std::max(decay_rate_of(a), decay_rate_of(b)) > 1.0;
  return std::abs(frequency_hz_of(a) - frequency_hz_of(b)) <
         (is_short ? 2.0 : 1.0) * (halfwidth_hz(a) + halfwidth_hz(b));
}

bool is_series_or_weak(const RepeatedMode& a, const RepeatedMode& b) {
  const auto [slow, fast] = std::minmax({decay_rate_of(a), decay_rate_of(b)});
  const auto [weak, strong] = std::minmax({a.amplitude, b.amplitude});
  return fast > series_ratio * slow || weak < weak_beside * strong;
}

// The complex amplitudes of two components in each decay at its first sample, their neighbours
// taken into account; decays that are too short are left out.
struct PairAmplitudes {
  Eigen::VectorXcd one;
  Eigen::VectorXcd other;
};

Band band_around(const RepeatedMode& a, const RepeatedMode& b, const FreeDecay& decay) {
  const double reach_hz =
      std::max({around_bandwidths * std::max(halfwidth_hz(a), halfwidth_hz(b)),
                around_share * frequency_hz_of(a), least_bins_around / 2.0 / decay.duration_s()});
  return {
      std::max(1.0 / decay.duration_s(),
               std::min(frequency_hz_of(a), frequency_hz_of(b)) - reach_hz),
      std::min(0.47 * decay.rate_hz, std::max(frequency_hz_of(a), frequency_hz_of(b)) + reach_hz)};
}

std::complex<double> amplitude_of(const DecayModel::State& state, Eigen::Index pole) {
  return {state.shares[2 * pole], -state.shares[2 * pole + 1]};
}

PairAmplitudes amplitudes(const RepeatedMode& a, const RepeatedMode& b,
                          const std::vector<FreeDecay>& decays,
                          const std::vector<RepeatedMode>& modes) {
  std::vector<std::complex<double>> of_a;
  std::vector<std::complex<double>> of_b;
  for (const FreeDecay& decay : decays) {
    const Band near = band_around(a, b, decay);
    std::vector<Pole> poles{{frequency_hz_of(a), a.damping_ratio.value},
                            {frequency_hz_of(b), b.damping_ratio.value}};
    for (const RepeatedMode& mode : modes) {
      if (&mode != &a && &mode != &b && mode.standing == Standing::agreed &&
          near.holds(frequency_hz_of(mode))) {
        poles.push_back({frequency_hz_of(mode), mode.damping_ratio.value});
      }
    }
    try {
      const BandSpectrum spectrum = band_spectrum(decay, near);
      const DecayModel model{spectrum, std::ssize(poles), {}};
      if (model.data().size() > model.unknowns()) {
        const DecayModel::State state = model.at(model.logs_of(poles));
        of_a.push_back(amplitude_of(state, 0));
        of_b.push_back(amplitude_of(state, 1));
      }
    } catch (const core::InvalidInput&) {
      continue;
    }
  }
  return {Eigen::Map<Eigen::VectorXcd>{of_a.data(), std::ssize(of_a)},
          Eigen::Map<Eigen::VectorXcd>{of_b.data(), std::ssize(of_b)}};
}

double assurance(const PairAmplitudes& pair) {
  return modal_assurance(pair.one, pair.other);
}

std::complex<double> median_ratio(const PairAmplitudes& pair) {
  std::vector<double> real;
  std::vector<double> imaginary;
  for (Eigen::Index i = 0; i < pair.one.size(); ++i) {
    if (std::abs(pair.one[i]) == 0.0) {
      continue;
    }
    const std::complex<double> ratio = pair.other[i] / pair.one[i];
    real.push_back(ratio.real());
    imaginary.push_back(ratio.imag());
  }
  return real.empty() ? std::complex<double>{}
                      : std::complex<double>{quantile(real, 0.5), quantile(imaginary, 0.5)};
}

// A quarter of the decays may have been struck twice or touched: unless all have one shape, those
// are left out that are farthest from the median proportion.
PairAmplitudes without_exceptions(PairAmplitudes pair) {
  const Eigen::Index exceptions = pair.one.size() / 4;
  if (exceptions == 0 || assurance(pair) >= one_shape) {
    return pair;
  }
  const std::complex<double> ratio = median_ratio(pair);
  std::vector<std::pair<double, Eigen::Index>> distances;
  for (Eigen::Index i = 0; i < pair.one.size(); ++i) {
    const double size = std::max(std::abs(ratio * pair.one[i]) + std::abs(pair.other[i]), 1e-300);
    distances.emplace_back(std::abs(pair.other[i] - ratio * pair.one[i]) / size, i);
  }
  std::ranges::sort(distances, std::ranges::greater{});
  for (Eigen::Index n = 0; n < exceptions; ++n) {
    const Eigen::Index left_out = distances[static_cast<std::size_t>(n)].second;
    pair.one[left_out] = 0.0;
    pair.other[left_out] = 0.0;
  }
  return pair;
}

// Whether the first has more energy after the first sample in most decays.
bool has_more_energy(const PairAmplitudes& pair, const RepeatedMode& one,
                     const RepeatedMode& other) {
  Eigen::Index more = 0;
  for (Eigen::Index i = 0; i < pair.one.size(); ++i) {
    more += std::norm(pair.one[i]) * decay_rate_of(other) >=
                    std::norm(pair.other[i]) * decay_rate_of(one)
                ? 1
                : 0;
  }
  return 2 * more >= pair.one.size();
}

void join(RepeatedMode& kept, RepeatedMode& part) {
  if (part.standing == Standing::agreed && kept.taps >= part.taps) {
    kept.standing = Standing::agreed;
    kept.agreed = std::max(kept.agreed, part.agreed);
    kept.why = {};
  }
  part.standing = Standing::doubtful;
  part.why = fmt::format("overlaps the mode at {:.5g} Hz and follows its amplitude",
                         frequency_hz_of(kept));
}

bool may_be_one(const RepeatedMode& a, const RepeatedMode& b) {
  return may_be_part(a) && may_be_part(b) && overlap(a, b) && is_series_or_weak(a, b) &&
         (a.standing == Standing::agreed || b.standing == Standing::agreed);
}

// Which mode each is a part of: itself, unless it was joined.
using Wholes = std::vector<std::size_t>;

void join_if_one(const std::vector<FreeDecay>& decays, std::size_t i, std::size_t k,
                 std::vector<RepeatedMode>& modes, Wholes& wholes) {
  const PairAmplitudes pair = without_exceptions(amplitudes(modes[i], modes[k], decays, modes));
  if (assurance(pair) < one_shape) {
    return;
  }
  const auto [kept, part] =
      has_more_energy(pair, modes[i], modes[k]) ? std::pair{i, k} : std::pair{k, i};
  const std::size_t whole = wholes[kept];  // a part of another mode does not become one again
  if (wholes[part] == part && whole != part) {
    wholes[part] = whole;
    join(modes[whole], modes[part]);
  }
}
}  // namespace

double likeness_over(const std::vector<FreeDecay>& decays, const std::vector<RepeatedMode>& modes,
                     std::size_t one, std::size_t other) {
  return assurance(amplitudes(modes[one], modes[other], decays, modes));
}

void join_resonances(const std::vector<FreeDecay>& decays, std::vector<RepeatedMode>& modes) {
  Wholes wholes(modes.size());
  std::iota(wholes.begin(), wholes.end(), std::size_t{0});
  for (std::size_t i = 0; i < modes.size(); ++i) {
    for (std::size_t k = i + 1; k < modes.size(); ++k) {
      if (may_be_one(modes[i], modes[k])) {
        join_if_one(decays, i, k, modes, wholes);
      }
    }
  }
}
}  // namespace tapstudy::analysis
