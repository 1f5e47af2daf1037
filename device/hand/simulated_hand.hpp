#pragma once
#include <vector>

#include "device/device.hpp"
#include "device/hand/hand_motion.hpp"
namespace tapstudy::device {
// What the hand perceives in one tick: position and applied force. Nothing about the plate.
struct FeltTick {
  core::HandState hand;
  core::Vec3 force_n;
};

// A hand that taps on its own and responds to the applied force: a MuscleBody whose aim follows a
// TapPath. Implements Device, for studies without hardware.
class SimulatedHand final : public Device {
 public:
  enum class Memory { kept, none };
  SimulatedHand(const core::HandBody& body, double dt_s, Memory memory);

  // Starts a new series of taps at the next tick and returns its duration. The first call places
  // the hand above the first point, at speed if there is no run-up; later calls move it there. If
  // the hand records what it feels, memory for the series is reserved here.
  double follow(std::vector<PlannedTap> taps);
  // Holds still where it is for so long; the first call places it in the middle of the workspace.
  void hold(double seconds);
  const std::vector<FeltTick>& felt() const noexcept { return felt_; }
  void forget() noexcept { felt_.clear(); }

  core::TickFault read(core::HandState& hand, double elapsed_s) noexcept override;
  core::TickFault write(const core::Vec3& force_n) noexcept override;
  DeviceDetail detail() const noexcept override { return {force_n_}; }
  std::string description() const override { return "simulated hand"; }

 private:
  void start(TapPath path, double duration_s);

  MuscleBody body_;
  double dt_s_;
  Memory memory_;
  TapPath path_{{}};
  std::int64_t ticks_{0};
  core::Vec3 aim_m_{core::Vec3::Zero()};  // at this tick: where the muscle pulls the hand
  bool has_started_{false};
  core::Vec3 force_n_{core::Vec3::Zero()};
  std::vector<FeltTick> felt_;
};
}  // namespace tapstudy::device
