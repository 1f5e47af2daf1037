#pragma once
#include <cstddef>
#include <vector>
namespace tapstudy::analysis {
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
}  // namespace tapstudy::analysis
