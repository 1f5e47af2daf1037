#pragma once
#include "core/settings/spidar_calibration.hpp"
#include "device/spidar/board.hpp"
#include "device/spidar/geometry.hpp"
namespace tapstudy::device {
// Throws InvalidInput if the calibration is implausible: motors of one kind that differ by more
// than a factor of three, or a maximum tension beyond the board's range of DAC counts.
void check_calibration(const core::SpidarCalibration& calibration);

// The DAC counts for a tension, clamped to the converter's range.
std::uint16_t dac_counts_of(double tension_n, const core::StringCalibration& string) noexcept;
DacCounts dac_counts_of(const PerString& tension_n,
                        const core::SpidarCalibration& calibration) noexcept;
}  // namespace tapstudy::device
