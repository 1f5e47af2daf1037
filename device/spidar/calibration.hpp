#pragma once
#include "core/settings/spidar_calibration.hpp"
#include "device/spidar/board.hpp"
#include "device/spidar/geometry.hpp"
namespace tapstudy::device {
// Throws InvalidInput if it cannot be true: motors of one kind that differ by more than threefold,
// or a largest tension that takes more DAC counts than the board has.
void check_calibration(const core::SpidarCalibration& calibration);

// How many DAC counts make a tension; never more than the converter has, never less than none.
std::uint16_t dac_counts_of(double tension_n, const core::StringCalibration& string) noexcept;
DacCounts dac_counts_of(const PerString& tension_n,
                        const core::SpidarCalibration& calibration) noexcept;
}  // namespace tapstudy::device
