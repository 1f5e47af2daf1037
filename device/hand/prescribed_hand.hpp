#pragma once
#include <cstddef>
#include <vector>

#include "device/device.hpp"
#include "device/hand/hand_motion.hpp"
namespace tapstudy::device {
// A hand whose muscle aims where it is told, tick by tick, and that responds to the applied force
// (MuscleBody). It starts at its first aim at rest, and rests at its last. Device frame.
class AimedHand final : public Device {
 public:
  // At least one aim.
  AimedHand(const core::HandBody& body, double dt_s, std::vector<core::Vec3> aims_m);
  core::TickFault read(core::HandState& hand, double elapsed_s) noexcept override;
  core::TickFault write(const core::Vec3& force_n) noexcept override;
  DeviceDetail detail() const noexcept override { return {force_n_}; }
  std::string description() const override { return "simulated hand"; }

 private:
  MuscleBody body_;
  std::vector<core::Vec3> aims_m_;
  std::size_t tick_{0};
  core::Vec3 force_n_{core::Vec3::Zero()};
};

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
