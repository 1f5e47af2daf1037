#pragma once
#include <functional>
#include <string>

#include "core/settings/device_settings.hpp"
#include "device/loop/tick_clock.hpp"
#include "device/spidar/board.hpp"
#include "device/usb/guardian.hpp"
namespace tapstudy::device {
// The operator's manual steps at the device.
class CalibrationOperator {
 public:
  virtual ~CalibrationOperator() = default;
  // Asks for a task; returns when it is done.
  virtual void please(const std::string& task) = 0;
  // Asks for a measured value: above zero, at most max. keep_waiting is called many times a second;
  // where it throws, so does this.
  virtual double how_much(const std::string& task, double max,
                          const std::function<void()>& keep_waiting) = 0;
  // Something that the operator must know at once.
  virtual void warn(const std::string& /*what*/) noexcept {}
};

// Upper limit of the output until a string's force constant is known: 2 N at 0.365 V/N, 6 N at
// 0.114 V/N, the two values published for the same frame.
inline constexpr std::uint16_t calibration_dac_counts = 300;
// So long a string pulls at most, however long the operator takes.
inline constexpr double max_pull_s = 60.0;

// Calibrates one string after the other: it is pulled out by a measured length, which gives metres
// per encoder count and the encoder's sign; then held by a force gauge at two outputs, whose
// difference gives newtons per DAC count and cancels the friction common to both. A string is
// measured again where its encoder did not move, where the force is not proportional to the output,
// or where it is unlike the strings before. All outputs are zero at the end, also on error. While a
// string pulls, the guardian monitors the program, which sends its heartbeat as long as the
// operator can be asked. Tensions are limited to 0.3 to 10 N, or to what the board can put out
// (editable afterwards). Throws DeviceError if the board fails, if a string has pulled for
// max_pull_s, or if the guardian took the force off.
core::SpidarCalibration calibrate_spidar(SpidarBoard& board, UsbPipe& pipe,
                                         WatchdogChannel& watchdog, TickClock& clock,
                                         CalibrationOperator& person);
}  // namespace tapstudy::device
