#pragma once
#include <chrono>
#include <cstdint>

#include "device/device.hpp"
namespace tapstudy::device {
// A device driven by another program on this machine, over UDP on the loopback (packets.hpp): each
// tick requests the position and waits for it, then sends the force, which is applied immediately.
class RemoteHand final : public Device {
 public:
  // Asks twenty times, for one to two seconds. Throws DeviceError if nobody answers.
  RemoteHand(std::uint16_t port, std::chrono::microseconds max_reply);
  ~RemoteHand() override;
  RemoteHand(const RemoteHand& other) = delete;
  RemoteHand& operator=(const RemoteHand& other) = delete;
  RemoteHand(RemoteHand&& other) = delete;
  RemoteHand& operator=(RemoteHand&& other) = delete;

  [[nodiscard]] core::TickFault read(core::HandState& hand) noexcept override;
  [[nodiscard]] core::TickFault write(const core::Vec3& force_n) noexcept override;
  void emergency_stop() noexcept override;
  DeviceDetail detail() const noexcept override { return {force_n_}; }
  std::string description() const override;

 private:
  core::TickFault send(bool wants_reply) noexcept;
  core::TickFault receive(core::HandState& hand) noexcept;
  bool wait_until(std::chrono::steady_clock::time_point end) const noexcept;

  std::uint16_t port_;
  std::chrono::microseconds max_reply_;
  int socket_;
  std::uint32_t number_{0};
  core::Vec3 force_n_{core::Vec3::Zero()};
};
}  // namespace tapstudy::device
