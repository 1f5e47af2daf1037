#pragma once
#include <optional>
#include <span>
#include <string>

#include "core/settings/device_settings.hpp"
#include "device/spidar/board.hpp"
#include "device/spidar/kinematics.hpp"
namespace tapstudy::device {
// Which quantity of the strings of one frame differs by more than a factor of three, as motors of
// one kind do not.
std::optional<std::string> differing_quantity(std::span<const core::StringCalibration> measured);
// The highest tension that the board's range of DAC counts allows for every string.
double highest_tension_n(const core::SpidarCalibration& calibration);
// Throws InvalidInput if the strings are unlike, or if max_tension_n is above the highest.
void check_calibration(const core::SpidarCalibration& calibration);

// The DAC counts for a tension, clamped to the converter's range.
std::uint16_t dac_counts_of(double tension_n, const core::StringCalibration& string) noexcept;
DacCounts dac_counts_of(const PerString& tension_n,
                        const core::SpidarCalibration& calibration) noexcept;
}  // namespace tapstudy::device
