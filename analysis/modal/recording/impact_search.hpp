#pragma once
#include <cstddef>
#include <vector>

#include "analysis/modal/recording/taps.hpp"
namespace tapstudy::analysis {
// What the samples before do not foretell: the errors of a linear prediction that is fitted to the
// whole recording (autoregressive, Yule 1927), as mean squares of frames of so many samples. What
// rings freely is foretold, beats and slow modes too; an impact is not. Samples of more than about
// 4 kHz are averaged before, so that the prediction looks back over several milliseconds.
std::vector<double> innovation_energies(const std::vector<double>& samples, double rate_hz,
                                        std::size_t frame);

inline constexpr std::size_t frames_per_group = 10;

std::size_t samples_in(double seconds, double rate_hz);
// Samples of a frame: 2 ms, 8 at least.
std::size_t frame_of(double rate_hz);

// Mean squares about the median, frame after frame.
struct Energies {
  std::size_t frame{};  // samples
  std::vector<double> of_frame;
  std::vector<double> innovations;  // likewise, see innovation_energies
  double floor{};                   // the noise's: the 20 % quantile of those of groups

  double of_group(std::size_t first) const;  // the mean from this frame on
};

Energies energies_of(const std::vector<double>& centred, double rate_hz);

// Where a sensor, centred on its median, was struck: see find_taps.
std::vector<Impact> sensor_impacts(const Energies& energies, const std::vector<double>& centred,
                                   double rate_hz);
// Where a force, centred likewise, has its pulses: see force_impacts.
std::vector<Impact> force_pulses(const std::vector<double>& centred, double noise_rms,
                                 double rate_hz);
}  // namespace tapstudy::analysis
