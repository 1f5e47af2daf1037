#pragma once
#include <array>
#include <span>
#include <vector>

#include "device/hand/simulated_hand.hpp"
namespace tapstudy::runner {
// What one tap felt like: the levels of vibration in bands of a third of an octave from 20 to
// 320 Hz, early (the first 40 ms of contact) and late (the next 120 ms), in decibels over the
// threshold of feeling. Early and late together hold amplitude and decay.
inline constexpr std::size_t bands = 13;
using Features = std::array<double, 2 * bands>;

struct FeltTap {
  core::Vec3 place_m;  // of the hand at first contact, device frame
  Features level_db;
};

// The taps in what a hand felt. The contact's own spring is taken out first: a hand that moves
// knows the soft resistance its motion meets (a straight line of force over depth, fitted to each
// contact) and attends to the rest. Levels do not fall below 0 dB: what is under the threshold
// amplitude is not felt.
std::vector<FeltTap> felt_taps(std::span<const device::FeltTick> felt, double dt_s,
                               double threshold_n);
}  // namespace tapstudy::runner
