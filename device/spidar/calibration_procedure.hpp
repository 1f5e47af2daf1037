#pragma once
#include "core/settings/spidar_calibration.hpp"
#include "device/spidar/board.hpp"
#include "device/spidar/calibration_operator.hpp"
namespace tapstudy::device {
// Nothing stronger is put out before a string's force is known: two newtons if a newton takes
// 0.365 V, six if it takes 0.114 V, the two scales that were published for one frame.
inline constexpr std::uint16_t calibration_dac_counts = 300;

// One string after the other: pulled out by a measured length, which gives metres per encoder count
// and the encoder's sign; then held by a force gauge at two outputs, whose difference gives newtons
// per DAC count without what friction adds to both. All outputs are zero at the end, whatever ended
// it. Tensions are limited to 0.3 to 10 N, for the researcher to change.
// Throws DeviceError if the board fails, if an encoder does not move, or if force does not grow in
// proportion to the output.
core::SpidarCalibration calibrate_spidar(SpidarBoard& board, UsbPipe& pipe,
                                         CalibrationOperator& person);
}  // namespace tapstudy::device
