#pragma once
#include <cstddef>
#include <vector>

#include "analysis/modal/recording/taps.hpp"
namespace tapstudy::analysis {
// The innovations of a recording: errors of a linear prediction fitted to the whole of it
// (autoregressive, Yule 1927), as mean squares over frames of this many samples. Free vibration is
// predictable, including beats and slow modes; an impact is not. Samples above about 4 kHz are
// averaged first, so that the prediction looks back over several milliseconds.
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
  double floor{};  // the noise's: the 20 % quantile of those of groups, without padding beside it
  double innovation_floor{};  // likewise
  double largest_innovation{};

  double of_group(std::size_t first) const;  // the mean from this frame on
};

Energies energies_of(const std::vector<double>& centred, double rate_hz);

// The impacts seen by a sensor, centred on its median: see find_taps.
std::vector<Impact> sensor_impacts(const Energies& energies, const std::vector<double>& centred,
                                   double rate_hz);
// The pulses of a force, centred on its median: see force_impacts.
std::vector<Impact> force_pulses(const std::vector<double>& centred, double noise_rms,
                                 double rate_hz);
}  // namespace tapstudy::analysis
