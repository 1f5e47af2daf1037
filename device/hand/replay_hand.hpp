#pragma once
#include <cstddef>
#include <vector>

#include "device/device.hpp"
namespace tapstudy::device {
// Replays a recorded motion tick by tick, regardless of the applied force; at the end it holds the
// last position.
class ReplayHand final : public Device {
 public:
  // At least one state. The source is recorded in the description.
  ReplayHand(std::vector<core::HandState> states, std::string source);
  void rewind() noexcept { next_ = 0; }

  [[nodiscard]] core::TickFault read(core::HandState& hand, double elapsed_s) noexcept override;
  [[nodiscard]] core::TickFault write(const core::Vec3& force_n) noexcept override;
  DeviceDetail detail() const noexcept override { return {}; }
  std::string description() const override { return "replay of " + source_; }

 private:
  std::vector<core::HandState> states_;
  std::string source_;
  std::size_t next_{0};
};
}  // namespace tapstudy::device
