#pragma once
#include <array>
namespace tapstudy::core {
inline constexpr int spidar_strings = 8;

// Calibration to be measured on each individual SPIDAR, string by string: published values of force
// per volt differ by a factor of three for the same frame.
struct StringCalibration {
  double metres_per_count{};  // of string paid out per positive encoder count; signed
  double volts_per_newton{};
  double dac_counts_per_volt{};
};

struct SpidarCalibration {
  double min_tension_n{0.3};  // below it a string goes slack
  double max_tension_n{0.3};
  std::array<StringCalibration, spidar_strings> strings{};
};
}  // namespace tapstudy::core
