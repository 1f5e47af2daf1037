#pragma once
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>

#include "core/haptics/haptic_state.hpp"
#include "device/device.hpp"
#include "device/frozen_reading.hpp"
#include "device/loop/tick_clock.hpp"
#include "device/remote/datagram_pipe.hpp"
namespace tapstudy::device {
// Of a measured force: less may be an offset, noise, or lost in friction.
inline constexpr double noticeable_n = 0.5;

// A device may report its force, not exert it, so much later than it was sent.
inline constexpr double max_report_lag_s = 0.02;

// Compares the force that a device reports with those that it was sent within max_report_lag_s.
// Faults are a report more than twice and 1 N above the largest of them along it, for 3 ms; one
// against the force while none was sent that way, for 6 ms; and one of almost nothing for 30 ms
// longer than the lag. Margins are wide, since devices measure coarsely. One that reports nothing
// (NaN) is not judged.
class ExertedForce {
 public:
  void forget() noexcept { *this = {}; }
  // Once a reply, with what was commanded when the device reported, and the time since the last.
  [[nodiscard]] core::TickFault judge(const core::Vec3& commanded_n, const core::Vec3& reported_n,
                                      double elapsed_s) noexcept;

 private:
  // The box of the commands of half a lag.
  struct Commands {
    core::Vec3 low_n{core::Vec3::Zero()};
    core::Vec3 high_n{core::Vec3::Zero()};
  };
  void remember(const core::Vec3& commanded_n, double elapsed_s) noexcept;
  double largest_along(const core::Vec3& direction) const noexcept;

  std::array<Commands, 3> recent_{};  // the current half lag first
  double current_s_{0.0};
  double above_s_{0.0};
  double against_s_{0.0};
  double without_s_{0.0};
};

// Compares the velocity that a device reports with the change of its position, since the strength
// of an impact rests on the velocity: one in other units, of another frame or always 0 is a fault
// after about a second of movement. Judged in windows of 50 ms in which the hand moves noticeably;
// a velocity that lags behind by some 30 ms disagrees only where the hand turns back.
class VelocityCheck {
 public:
  void forget() noexcept { *this = {}; }
  // Once a reply, with the time since the last one.
  [[nodiscard]] core::TickFault judge(const core::HandState& hand, double elapsed_s) noexcept;

 private:
  bool has_begun_{false};
  core::Vec3 began_at_m_{core::Vec3::Zero()};
  core::Vec3 integrated_m_{core::Vec3::Zero()};
  double window_s_{0.0};
  int disagreements_{0};  // less the agreements, from 0
};

// A device driven by another program on this machine, over UDP on the loopback (packets.hpp): each
// tick requests the position and waits for it, then sends the force, which is applied immediately.
class RemoteHand final : public Device {
 public:
  // Asks forty times, for two to four seconds: the other program may still wait for an earlier one.
  // Throws DeviceError if nobody answers.
  RemoteHand(std::uint16_t port, std::chrono::microseconds max_reply);
  RemoteHand(std::uint16_t port, std::chrono::microseconds max_reply,
             std::unique_ptr<DatagramPipe> pipe);
  ~RemoteHand() override;
  RemoteHand(const RemoteHand& other) = delete;
  RemoteHand& operator=(const RemoteHand& other) = delete;
  RemoteHand(RemoteHand&& other) = delete;
  RemoteHand& operator=(RemoteHand&& other) = delete;

  [[nodiscard]] core::TickFault read(core::HandState& hand, double elapsed_s) noexcept override;
  [[nodiscard]] core::TickFault write(const core::Vec3& force_n) noexcept override;
  [[nodiscard]] core::TickFault begin() noexcept override;
  [[nodiscard]] StopOutcome zero_force() noexcept override;
  StopOutcome emergency_stop() noexcept override { return zero_force(); }
  DeviceDetail detail() const noexcept override { return detail_; }
  std::string description() const override;
  // Falls silent for so long, and asks whether the other program has released the force meanwhile.
  enum class Release {
    released,
    held,
    always_reported,  // while it is asked, too: the report says nothing
    not_reported      // by version 1; or there was no reply
  };
  Release release_after(std::chrono::milliseconds silence) noexcept;
  // How long requests take that carry zero force; one without a reply counts as the longest.
  LatenessCount round_trips() noexcept;

 private:
  core::TickFault send(bool wants_reply) noexcept;
  core::TickFault ask(core::HandState& hand) noexcept;
  core::TickFault receive(core::HandState& hand) noexcept;
  core::TickFault fault_of_report(double elapsed_s) noexcept;
  core::TickFault fault_of_motion(const core::HandState& hand, double elapsed_s) noexcept;
  void sleep_for(std::chrono::nanoseconds duration) noexcept;

  std::uint16_t port_;
  std::chrono::nanoseconds max_reply_;
  std::unique_ptr<DatagramPipe> pipe_;
  std::uint32_t number_{0};
  core::Vec3 force_n_{core::Vec3::Zero()};
  HeldHand held_;
  core::HandState last_;
  FrozenReading reading_;
  ExertedForce exerted_;
  VelocityCheck velocity_;
  double since_reply_s_{0.0};
  bool tells_status_{false};  // a reply was of version 2: none may be of version 1 then
  bool is_holding_{false};    // a reply of this trial reported so
  int released_replies_{0};   // of this trial, in a row
  std::optional<std::uint32_t> status_;
  DeviceDetail detail_;
};
}  // namespace tapstudy::device
