#pragma once
#include <array>
#include <span>
#include <vector>

#include "device/hand/simulated_hand.hpp"
namespace tapstudy::runner {
// Perceptual features of one tap: third-octave vibration levels from 20 to 320 Hz, early (the first
// 40 ms from the impact on, rebounds included) and late (the next 120 ms), in decibels above the
// detection threshold. Early and late levels together capture amplitude and decay.
inline constexpr std::size_t bands = 13;
using Features = std::array<double, 2 * bands>;

struct FeltTap {
  core::Vec3 place_m;  // of the hand at first contact, device frame
  Features level_db;
};

// Extracts the taps from the recorded ticks. The contact spring is removed first: a moving hand can
// predict the compliant resistance (a linear fit of force against depth for each contact) and
// attends to the remainder. Levels are clamped at 0 dB: amplitudes below threshold are not felt.
std::vector<FeltTap> felt_taps(std::span<const device::FeltTick> felt, double dt_s,
                               double threshold_n);
}  // namespace tapstudy::runner
