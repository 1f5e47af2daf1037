#pragma once
#include <string>
#include <vector>

#include "runner/experiments/scripted_tap.hpp"
namespace tapstudy::runner {
inline constexpr double shown_s = 0.3;  // from a little before the impact on
inline constexpr double low_limit_hz = 100.0;

// What a tap's trace says of its force, from the impact on.
struct TapForce {
  double penalty_n{};  // largest magnitudes
  double vibration_n{};
  double low_n{};   // of the vibration below 100 Hz, by the discrete Fourier transform
  double high_n{};  // and of the rest
  std::vector<double> t_s;
  std::vector<double> penalty;  // [N]
  std::vector<double> vibration;
};
// Throws InvalidInput if there is no impact.
TapForce tap_force(const std::vector<core::TraceSample>& trace, double rate_hz);

// The whole force over time, and the vibration alone below it, both in newtons.
std::string force_svg(const TapForce& force, const std::string& title);
}  // namespace tapstudy::runner
