#pragma once
#include <optional>

#include "core/haptics/haptic_state.hpp"
#include "device/device.hpp"
#include "device/spidar/board.hpp"
#include "device/usb/guardian.hpp"
namespace tapstudy::device {
// The exchanges with a board, one a tick, under the guardian's watch: what is sent, what comes
// back, whether that is the answer to it, and whether force is known to be off.
class BoardLink {
 public:
  // The pipe, the board and the watchdog's channel, if any, must outlive it.
  BoardLink(UsbPipe& pipe, SpidarBoard& board, WatchdogChannel* watchdog, double dt_s) noexcept;

  // The board's first exchange, with zero force.
  [[nodiscard]] UsbOutcome open() noexcept;
  // No force without a guardian that is seen to be alive; waits for it, up to 0.1 s.
  [[nodiscard]] core::TickFault begin_watch() noexcept;
  void end_watch() noexcept;
  void take_over_from_guardian() noexcept;
  // Sends these outputs. no_reply may be followed by another exchange: its late reply will not be
  // taken for the next one if the board echoes.
  [[nodiscard]] core::TickFault exchange(const DacCounts& outputs, double elapsed_s) noexcept;
  bool can_miss_a_reply() const noexcept { return reading_.echo.has_value(); }
  const BoardReading& reading() const noexcept { return reading_; }
  // Whether the last reply carries what was sent last; true where the board does not echo.
  bool is_last_echoed() const noexcept { return reading_.echo.value_or(sent_) == sent_; }
  // Sets all outputs to zero, three times; unconfirmed if no reply says so. The guardian then
  // repeats it until one does. The echo of a board that has stopped counting confirms nothing: what
  // sends it may be all that is alive.
  StopOutcome stop(bool is_counting) noexcept;
  bool is_force_off() const noexcept;

 private:
  bool is_watched() const noexcept;
  core::TickFault fault_of_watchdog(double elapsed_s) noexcept;
  UsbOutcome exchange_as_owner(DacCounts outputs) noexcept;
  bool is_echo_right() noexcept;

  UsbPipe& pipe_;
  SpidarBoard& board_;
  WatchdogChannel* watchdog_;
  double dt_s_;
  BoardReading reading_;
  DacCounts sent_{};
  DacCounts sent_before_{};
  std::optional<bool> echoes_this_request_;
  int missed_replies_{0};  // in a row; their replies may still come
  std::uint64_t guardian_rounds_{0};
  double guardian_silent_s_{0.0};
  bool is_force_off_{true};
  bool is_counting_{true};
};
}  // namespace tapstudy::device
