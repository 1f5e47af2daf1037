#pragma once
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "core/haptics/haptic_state.hpp"
#include "device/device.hpp"
#include "device/frozen_reading.hpp"
#include "device/loop/tick_clock.hpp"
#include "device/remote/datagram_pipe.hpp"
#include "device/remote/packets.hpp"
#include "device/remote/reply_checks.hpp"
#include "device/remote/shared_text.hpp"
#include "device/velocity_estimate.hpp"
namespace tapstudy::device {
struct RemoteLimits {
  std::chrono::microseconds max_reply{3000};  // a reply that takes longer is missing
  double max_sample_age_s{0.005};             // of a position, where the program tells (version 3)
};

// A device driven by another program on this machine, over UDP on the loopback (packets.hpp).
// Version 3: each tick is one exchange, read() sends the force of the last write() and receives the
// newest sample, so that a force acts one tick after the position that it was computed from.
// Versions 1 and 2: read() requests the position, write() sends the force, which acts at once.
class RemoteHand final : public Device {
 public:
  // Asks forty times, for two to four seconds: the other program may still wait for an earlier one.
  // Throws DeviceError if nobody answers, or with an introduction that cannot be true.
  RemoteHand(std::uint16_t port, RemoteLimits limits);
  RemoteHand(std::uint16_t port, RemoteLimits limits, std::unique_ptr<DatagramPipe> pipe);
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

  int version() const noexcept { return version_; }
  // Of version 3.
  const std::optional<RemoteDescription>& introduction() const noexcept { return introduction_; }
  // What its last reply says to the operator (version 3); empty: nothing. Any thread.
  std::string text() const { return text_.get(); }
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
  bool greet(std::optional<wire::Introduction>& told);
  core::TickFault ask_who_it_is() noexcept;
  core::TickFault send(std::span<const std::uint8_t> datagram) noexcept;
  core::TickFault send_force(RequestKind kind) noexcept;
  core::TickFault ask() noexcept;
  template <class Take>
  core::TickFault receive(const Take& take) noexcept;
  bool is_understood(std::span<const std::uint8_t> bytes,
                     std::optional<wire::Introduction>& told) noexcept;
  core::TickFault take_reply(double elapsed_s) noexcept;
  core::TickFault fault_of_status(std::uint32_t status, double elapsed_s) noexcept;
  core::TickFault fault_of_motion(double elapsed_s) noexcept;
  void estimate_velocity(double elapsed_s) noexcept;
  int max_requests_of_a_stop() const noexcept;
  bool shows_no_force(SamplesSince& samples, Nanoseconds since) noexcept;
  void sleep_for(std::chrono::nanoseconds duration) noexcept;

  // Positions of 0.1 mm alone: a hand that drifts by 50 um/s and more passes three of them.
  static constexpr double max_still_s = 6.0;
  std::uint16_t port_;
  std::chrono::nanoseconds max_reply_;
  std::unique_ptr<DatagramPipe> pipe_;
  int version_{0};
  std::optional<RemoteDescription> introduction_;
  wire::Introduction told_;  // likewise, as it came
  SampleCheck samples_;
  std::uint32_t number_{0};
  core::Vec3 force_n_{core::Vec3::Zero()};
  RemoteReply reply_;
  HeldHand held_;
  FrozenReading reading_;
  FrozenReading position_{max_still_s};  // by itself, should the velocity go on
  ExertedForce exerted_;
  VelocityCheck velocity_;
  VelocityEstimate estimate_;
  double since_reply_s_{0.0};
  double since_sample_s_{0.0};
  bool is_velocity_measured_{true};
  bool is_holding_{false};  // a reply of this trial reported so
  double released_s_{0.0};  // so long every reply of this trial reported a release
  SharedText<sizeof(wire::Reply::text)> text_;
  DeviceDetail detail_;
};
}  // namespace tapstudy::device
