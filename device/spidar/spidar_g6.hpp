#pragma once
#include <memory>
#include <optional>

#include "device/device.hpp"
#include "device/spidar/calibration.hpp"
#include "device/spidar/tensions.hpp"
#include "device/usb/watchdog_channel.hpp"
namespace tapstudy::device {
struct SpidarLimits {
  double max_residual_m{2e-4};       // beyond it a string is slack, slipped or miscounted
  double max_string_speed_m_s{5.0};  // beyond it a counter has jumped
  double max_turn_rad{0.5};          // of the grip
};

struct SpidarSettings {
  SpidarGeometry geometry;
  core::SpidarCalibration calibration;
  SpidarLimits limits;
  double dt_s{1e-3};
  WatchdogChannel* watchdog{nullptr};  // of the guardian, if any; must outlive the device
};

// A SPIDAR-G6 on a USB board. Its states: open (outputs zero) → taut (minimum tension, ramped up) →
// homed (the grip was held in the centre, all lengths known), then read and write. One exchange per
// tick: read() sends the tensions computed by the last write() and receives the counters, so the
// force acts one tick after the position it was computed from.
//
// The commanded torque is zero: a tap is a pure force at the finger. Any error on the wire, in the
// counters or in the pose is a fault; emergency_stop() then zeroes all outputs, strings may go
// slack, and the grip must be homed again.
class SpidarG6 final : public Device {
 public:
  // The pipe and the board must outlive it. Throws DeviceError if the board does not reply, or its
  // reply is invalid.
  SpidarG6(UsbPipe& pipe, SpidarBoard& board, SpidarSettings settings);
  ~SpidarG6() override;
  SpidarG6(const SpidarG6& other) = delete;
  SpidarG6& operator=(const SpidarG6& other) = delete;
  SpidarG6(SpidarG6&& other) = delete;
  SpidarG6& operator=(SpidarG6&& other) = delete;

  // One step of the tension ramp, 0 to 1 of the minimum; to be called at the loop rate.
  [[nodiscard]] core::TickFault tighten(double share) noexcept;
  // Takes the present pose as the origin: grip in the centre and not rotated.
  [[nodiscard]] core::TickFault home() noexcept;
  bool is_homed() const noexcept { return is_homed_; }
  int rotary_switch() const noexcept { return reading_.rotary_switch(); }

  [[nodiscard]] core::TickFault read(core::HandState& hand) noexcept override;
  [[nodiscard]] core::TickFault write(const core::Vec3& force_n) noexcept override;
  void begin() noexcept override;
  void zero_force() noexcept override;
  void emergency_stop() noexcept override;
  DeviceDetail detail() const noexcept override { return detail_; }
  std::string description() const override;

 private:
  core::TickFault fault_of_watchdog() noexcept;
  core::TickFault exchange() noexcept;
  void end_watchdog() const noexcept;
  core::TickFault follow(core::HandState& hand) noexcept;
  bool is_echo_right() noexcept;

  UsbPipe& pipe_;
  SpidarBoard& board_;
  SpidarSettings settings_;
  TensionSolver tension_solver_;
  UnwrappedCounters counters_;
  PerString length_at_rest_m_;
  Pose pose_;
  Strings strings_;
  core::Vec3 velocity_m_s_{core::Vec3::Zero()};
  DacCounts dac_counts_{};
  DacCounts sent_{};
  DacCounts sent_before_{};
  std::optional<bool> echoes_this_request_;
  BoardReading reading_;
  std::int64_t largest_step_{0};
  std::uint64_t guardian_rounds_{0};
  double guardian_silent_s_{0.0};
  bool is_homed_{false};
  bool has_position_{false};
  DeviceDetail detail_;
};
}  // namespace tapstudy::device
