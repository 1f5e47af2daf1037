#pragma once
#include <memory>

#include "device/device.hpp"
#include "device/frozen_reading.hpp"
#include "device/spidar/board_link.hpp"
#include "device/spidar/calibration.hpp"
#include "device/spidar/tensions.hpp"
#include "device/usb/guardian.hpp"
#include "device/velocity_estimate.hpp"
namespace tapstudy::device {
struct SpidarLimits {
  double max_residual_m{2e-4};       // beyond it a string is slack, slipped or miscounted
  double max_string_speed_m_s{5.0};  // beyond it a counter has jumped
  double max_turn_rad{0.5};          // of the grip
  double min_motor_voltage_v{0.05};  // mean over the strings; less is an amplifier that is off
  double max_without_voltage_s{0.02};
};

struct SpidarSettings {
  SpidarGeometry geometry;
  core::SpidarCalibration calibration;
  SpidarLimits limits;
  double dt_s{1e-3};
  bool is_amplifier_sensed{
      true};  // false: the board's measurement of voltages is not to be relied on
  WatchdogChannel* watchdog{nullptr};  // of the guardian, if any; must outlive the device
};

// A SPIDAR-G6 on a USB board. Its states: open (outputs zero) → taut (minimum tension, ramped up) →
// homed (the grip was held in the centre, all lengths known), then read and write. One exchange per
// tick: read() sends the tensions computed by the last write() and receives the counters, so the
// force acts one tick after the position it was computed from.
//
// The commanded torque is zero: a tap is a pure force at the finger. A few replies in a row may be
// missing; any other error on the wire, in the counters or in the pose is a fault. emergency_stop()
// then zeroes all outputs, strings may go slack, and the grip must be homed again. A stop that is
// not confirmed by a reply leaves the guardian to repeat zero force until one comes.
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
  // Whether the motors get voltage; true where the board does not measure it.
  bool has_motor_voltage() const noexcept;
  int rotary_switch() const noexcept { return link_.reading().rotary_switch(); }

  [[nodiscard]] core::TickFault read(core::HandState& hand, double elapsed_s) noexcept override;
  [[nodiscard]] core::TickFault write(const core::Vec3& force_n) noexcept override;
  [[nodiscard]] core::TickFault begin() noexcept override;
  [[nodiscard]] StopOutcome zero_force() noexcept override;
  StopOutcome emergency_stop() noexcept override;
  bool is_force_off() const noexcept override { return link_.is_force_off(); }
  DeviceDetail detail() const noexcept override { return detail_; }
  std::string description() const override;

 private:
  core::TickFault exchange(double elapsed_s) noexcept;
  core::TickFault exchange_patiently() noexcept;
  core::TickFault fault_of_amplifier(double elapsed_s) noexcept;
  core::TickFault fault_of_counters(double elapsed_s) noexcept;
  core::TickFault follow(core::HandState& hand, double elapsed_s) noexcept;
  double longest_step_m() const noexcept;
  PerString lengths_m() const noexcept;

  SpidarSettings settings_;
  BoardLink link_;
  const char* board_name_;
  TensionSolver tension_solver_;
  UnwrappedCounters counters_;
  PerString length_at_rest_m_;
  Pose pose_;
  Strings strings_;
  VelocityEstimate velocity_;
  DacCounts dac_counts_{};
  std::int64_t largest_step_{0};
  bool is_homed_{false};
  HeldHand held_;
  core::Vec3 force_n_{core::Vec3::Zero()};  // the last that was written
  FrozenReading counts_;
  bool is_frozen_{false};
  double unread_s_{0.0};  // since the position was last read
  double without_voltage_s_{0.0};
  DeviceDetail detail_;
};
}  // namespace tapstudy::device
