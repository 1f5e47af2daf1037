#pragma once
#include <vector>

#include "device/device.hpp"
#include "device/hand/muscle_body.hpp"
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
}  // namespace tapstudy::device
