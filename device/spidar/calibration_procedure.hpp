#pragma once
#include "core/settings/spidar_calibration.hpp"
#include "device/spidar/board.hpp"
#include "device/spidar/calibration_operator.hpp"
namespace tapstudy::device {
// Upper limit of the output until a string's force constant is known: 2 N at 0.365 V/N, 6 N at
// 0.114 V/N, the two values published for the same frame.
inline constexpr std::uint16_t calibration_dac_counts = 300;

// Calibrates one string after the other: it is pulled out by a measured length, which gives metres
// per encoder count and the encoder's sign; then held by a force gauge at two outputs, whose
// difference gives newtons per DAC count and cancels the friction common to both. All outputs are
// zero at the end, also on error. Tensions are limited to 0.3 to 10 N (editable afterwards).
// Throws DeviceError if the board fails, if an encoder does not move, or if the force is not
// proportional to the output.
core::SpidarCalibration calibrate_spidar(SpidarBoard& board, UsbPipe& pipe,
                                         CalibrationOperator& person);
}  // namespace tapstudy::device
