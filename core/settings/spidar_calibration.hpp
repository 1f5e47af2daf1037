#pragma once
#include <array>
namespace tapstudy::core {
inline constexpr int spidar_strings = 8;

// What must be measured on every single SPIDAR, string by string: force per volt alone differs
// threefold between published tables for one and the same frame.
struct StringCalibration {
  double metres_per_count{};  // of string let out per encoder count up; the sign is the encoder's
  double volts_per_newton{};
  double dac_counts_per_volt{};
};

struct SpidarCalibration {
  double min_tension_n{0.3};  // below it a string goes slack
  double max_tension_n{0.3};
  std::array<StringCalibration, spidar_strings> strings{};
};
}  // namespace tapstudy::core
