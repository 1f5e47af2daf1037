#include "device/spidar/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.hpp"
namespace tapstudy::device {
namespace {
constexpr double max_ratio = 3.0;

double dac_counts_per_newton(const core::StringCalibration& string) {
  return string.volts_per_newton * string.dac_counts_per_volt;
}

std::optional<std::string> unlikeness_in(const char* what, const std::vector<double>& of_string) {
  const auto [smallest, largest] = std::ranges::minmax_element(of_string);
  if (*largest <= max_ratio * *smallest) {
    return std::nullopt;
  }
  return fmt::format(
      "{} is {:.3g} for string {} and {:.3g} for string {} (motors of one kind do not differ more "
      "than threefold: measure again)",
      what, *smallest, smallest - of_string.begin() + 1, *largest, largest - of_string.begin() + 1);
}
}  // namespace

std::optional<std::string> differing_quantity(std::span<const core::StringCalibration> measured) {
  std::vector<double> metres_per_count;
  std::vector<double> counts_per_newton;
  for (const core::StringCalibration& string : measured) {
    metres_per_count.push_back(std::abs(string.metres_per_count));
    counts_per_newton.push_back(dac_counts_per_newton(string));
  }
  const auto in_lengths = unlikeness_in("metres_per_count", metres_per_count);
  return in_lengths
             ? in_lengths
             : unlikeness_in("volts_per_newton times dac_counts_per_volt", counts_per_newton);
}

double highest_tension_n(const core::SpidarCalibration& calibration) {
  const auto weakest = std::ranges::max_element(calibration.strings, {}, dac_counts_per_newton);
  return max_dac_counts / dac_counts_per_newton(*weakest);
}

void check_calibration(const core::SpidarCalibration& calibration) {
  if (const auto in = differing_quantity(calibration.strings)) {
    throw core::InvalidInput{"calibration: " + *in};
  }
  const double highest_n = highest_tension_n(calibration);
  if (calibration.max_tension_n > highest_n) {
    throw core::InvalidInput{fmt::format(
        "calibration: max_tension_n, {} N, is above {:.4g} N, which take all {} DAC counts of the "
        "board (lower it, or measure again)",
        calibration.max_tension_n, highest_n, max_dac_counts)};
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
