#include "device/spidar/calibration.hpp"

#include <algorithm>
#include <cmath>
namespace tapstudy::device {
std::uint16_t digits_of(double tension_n, const StringCalibration& string) noexcept {
  const double digits = tension_n * string.volts_per_newton * string.digits_per_volt;
  return std::isfinite(digits)
             ? static_cast<std::uint16_t>(std::clamp(digits, 0.0, double{most_digits}))
             : std::uint16_t{0};
}

Digits digits_of(const PerString& tension_n, const SpidarCalibration& calibration) noexcept {
  Digits digits{};
  for (std::size_t i = 0; i < digits.size(); ++i) {
    digits[i] = digits_of(tension_n[static_cast<Eigen::Index>(i)], calibration.string[i]);
  }
  return digits;
}
}  // namespace tapstudy::device
