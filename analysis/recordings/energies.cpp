#include "analysis/recordings/energies.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/recordings/innovation.hpp"
#include "analysis/statistics/quantiles.hpp"
namespace tapstudy::analysis {
namespace {
constexpr double frame_s = 0.002;
constexpr std::size_t min_frame = 8;
}  // namespace

std::size_t samples_in(double seconds, double rate_hz) {
  return static_cast<std::size_t>(std::llround(seconds * rate_hz));
}

std::size_t frame_of(double rate_hz) {
  return std::max(min_frame, samples_in(frame_s, rate_hz));
}

double Energies::of_group(std::size_t first) const {
  const std::size_t count = std::min(frames_per_group, of_frame.size() - first);
  const auto begin = of_frame.begin() + static_cast<std::ptrdiff_t>(first);
  return std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(count), 0.0) /
         static_cast<double>(count);
}

Energies energies_of(const std::vector<double>& centred, double rate_hz) {
  Energies energies{frame_of(rate_hz), {}, {}, 0.0};
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
}  // namespace tapstudy::analysis
