#pragma once
#include <array>
#include <string>

#include "device/spidar/board.hpp"
#include "device/spidar/tensions.hpp"
namespace tapstudy::device {
// What must be measured on every single SPIDAR: force per volt alone differs threefold between
// published tables for one and the same frame.
struct StringCalibration {
  double metres_per_count{};  // of string let out per count up; the sign is the encoder's
  double volts_per_newton{};
  double digits_per_volt{};
};

struct SpidarCalibration {
  std::array<StringCalibration, strings> string;
  TensionRange range{0.3, 0.3};
};

// How many digits make a tension; never more than the converter has, never less than none.
std::uint16_t digits_of(double tension_n, const StringCalibration& string) noexcept;
Digits digits_of(const PerString& tension_n, const SpidarCalibration& calibration) noexcept;
}  // namespace tapstudy::device
