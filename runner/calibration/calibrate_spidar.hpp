#pragma once
#include <ostream>

#include "device/spidar/board.hpp"
#include "device/spidar/calibration.hpp"
#include "runner/calibration/operator.hpp"
namespace tapstudy::runner {
// Nothing stronger is put out before a string's force is known: two newtons if a newton takes
// 0.365 V, six if it takes 0.114 V, the two scales that were published for one frame.
inline constexpr std::uint16_t calibration_digits = 300;

// One string after the other: pulled out by a measured length, which gives metres a count and the
// encoder's sign; then held by a force gauge at two outputs, whose difference gives newtons a digit
// without what friction adds to both. All outputs are zero at the end, whatever ended it.
// Throws DeviceError if the board fails, if an encoder does not move, or if force does not grow in
// proportion to the output.
std::array<device::StringCalibration, device::strings> calibrate_spidar(device::SpidarBoard& board,
                                                                        device::UsbPipe& pipe,
                                                                        Operator& person);

// As a rig's calibration file has it.
void write_calibration(std::ostream& out, const std::string& type,
                       const std::array<device::StringCalibration, device::strings>& strings);
}  // namespace tapstudy::runner
