#pragma once
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "analysis/modal/decay/free_decay.hpp"
#include "analysis/modal/recording/recording.hpp"
#include "core/random/rng.hpp"
// Sums of damped oscillations with planted parameters, in noise.
namespace tapstudy::testing {
struct PlantedMode {
  analysis::Pole pole;
  double amplitude{1.0};
  double phase_rad{-std::numbers::pi / 2.0};  // a sine, as after an impulse
};

// Re(c exp(s t)), t from 0.
inline double ringing(const std::vector<PlantedMode>& modes, double t_s) {
  double sum = 0.0;
  for (const PlantedMode& mode : modes) {
    const double omega = 2.0 * std::numbers::pi * mode.pole.frequency_hz;
    const double ratio = mode.pole.damping_ratio;
    sum += mode.amplitude * std::exp(-ratio * omega * t_s) *
           std::cos(omega * std::sqrt(1.0 - ratio * ratio) * t_s + mode.phase_rad);
  }
  return sum;
}

inline analysis::FreeDecay planted_decay(const std::vector<PlantedMode>& modes, double rate_hz,
                                         double duration_s) {
  analysis::FreeDecay decay{rate_hz, Eigen::VectorXd(std::lround(rate_hz * duration_s))};
  for (Eigen::Index n = 0; n < decay.samples.size(); ++n) {
    decay.samples[n] = ringing(modes, static_cast<double>(n) / rate_hz);
  }
  return decay;
}

// The standard deviation of noise, by the ratio of the decay's mean power to it, in dB.
inline double noise_for(const analysis::FreeDecay& decay, double signal_to_noise_db) {
  const double power = decay.samples.squaredNorm() / static_cast<double>(decay.samples.size());
  return std::sqrt(power * std::pow(10.0, -signal_to_noise_db / 10.0));
}

// White noise of that ratio.
inline double add_noise(analysis::FreeDecay& decay, double signal_to_noise_db, core::Rng& rng) {
  const double noise = noise_for(decay, signal_to_noise_db);
  for (double& sample : decay.samples) {
    sample += noise * rng.normal();
  }
  return noise;
}

// Taps at these times in noise of this standard deviation; each rings until the end.
inline analysis::Recording planted_recording(const std::vector<PlantedMode>& modes,
                                             const std::vector<double>& times_s, double rate_hz,
                                             double duration_s, double noise, std::uint64_t seed) {
  analysis::Recording recording{"planted.csv", "x", rate_hz, {}, {}};
  core::Rng rng{seed};
  const auto count = static_cast<std::size_t>(std::lround(rate_hz * duration_s));
  for (std::size_t n = 0; n < count; ++n) {
    const double t_s = static_cast<double>(n) / rate_hz;
    double value = noise * rng.normal();
    for (const double begin_s : times_s) {
      value += t_s >= begin_s ? ringing(modes, t_s - begin_s) : 0.0;
    }
    recording.samples.push_back(value);
  }
  return recording;
}
}  // namespace tapstudy::testing
