#pragma once
#include "analysis/recordings/energies.hpp"
#include "analysis/recordings/taps.hpp"
namespace tapstudy::analysis {
// Where a sensor, centred on its median, was struck: see find_taps.
std::vector<Impact> sensor_impacts(const Energies& energies, const std::vector<double>& centred,
                                   double rate_hz);
// Where a force, centred likewise, has its pulses: see force_impacts.
std::vector<Impact> force_pulses(const std::vector<double>& centred, double noise_rms,
                                 double rate_hz);
}  // namespace tapstudy::analysis
