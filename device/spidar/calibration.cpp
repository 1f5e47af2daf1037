#include "device/spidar/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.hpp"
namespace tapstudy::device {
namespace {
constexpr double max_ratio = 3.0;

void check_alike(const char* what, std::array<double, strings> of_string) {
  for (double& value : of_string) {
    value = std::abs(value);
  }
  const auto [smallest, largest] = std::ranges::minmax_element(of_string);
  if (*largest > max_ratio * *smallest) {
    throw core::InvalidInput{fmt::format(
        "calibration: {} is {:.3g} for string {} and {:.3g} for string {} (motors of one kind do "
        "not differ more than threefold: measure again)",
        what, *smallest, smallest - of_string.begin() + 1, *largest,
        largest - of_string.begin() + 1)};
  }
}
}  // namespace

void check_calibration(const core::SpidarCalibration& calibration) {
  std::array<double, strings> metres_per_count{};
  std::array<double, strings> counts_per_newton{};
  for (std::size_t i = 0; i < calibration.strings.size(); ++i) {
    const core::StringCalibration& string = calibration.strings.at(i);
    metres_per_count.at(i) = string.metres_per_count;
    counts_per_newton.at(i) = string.volts_per_newton * string.dac_counts_per_volt;
  }
  check_alike("metres_per_count", metres_per_count);
  check_alike("volts_per_newton times dac_counts_per_volt", counts_per_newton);
  const double needed = calibration.max_tension_n * std::ranges::max(counts_per_newton);
  if (needed > max_dac_counts) {
    throw core::InvalidInput{
        fmt::format("calibration: max_tension_n, {} N, would take {:.0f} DAC counts (the board has "
                    "{}: lower it, or measure again)",
                    calibration.max_tension_n, needed, max_dac_counts)};
  }
}

std::uint16_t dac_counts_of(double tension_n, const core::StringCalibration& string) noexcept {
  const double counts = tension_n * string.volts_per_newton * string.dac_counts_per_volt;
  return std::isfinite(counts)
             ? static_cast<std::uint16_t>(std::clamp(counts, 0.0, double{max_dac_counts}))
             : std::uint16_t{0};
}

DacCounts dac_counts_of(const PerString& tension_n,
                        const core::SpidarCalibration& calibration) noexcept {
  DacCounts counts{};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    counts[i] = dac_counts_of(tension_n[static_cast<Eigen::Index>(i)], calibration.strings[i]);
  }
  return counts;
}
}  // namespace tapstudy::device
