#pragma once
#include <vector>

#include "core/settings/hand_body.hpp"
#include "core/tick/state_transition.hpp"
#include "device/device.hpp"
#include "device/hand/tap_path.hpp"
namespace tapstudy::device {
// The motion of hand and muscle over dt round a fixed aim, as long as nothing pushes.
core::StateTransition muscle_transition(const core::HandBody& body, double dt_s) noexcept;

// What a hand knows of one tick: where it was and the force it was given. Nothing about the plate.
struct FeltTick {
  core::HandState hand;
  core::Vec3 force_n;
};

// A hand that taps by itself and is pushed back by the force it is given: m x'' = k (a - x) +
// b (a' - x') + f, with the muscle's aim a from a TapPath; between ticks f, a and a' are held, and
// the motion is exact. A device like any other, for studies without hardware.
class SimulatedHand final : public Device {
 public:
  enum class Memory { kept, none };
  SimulatedHand(const core::HandBody& body, double dt_s, Memory memory);

  // Starts a new series of taps at the next tick and returns how long it takes. The first call puts
  // the hand above the first point, at speed if there is no run-up; later ones let it travel there.
  // A hand that remembers takes room for what it will feel meanwhile.
  double follow(std::vector<PlannedTap> taps);
  const std::vector<FeltTick>& felt() const noexcept { return felt_; }
  void forget() noexcept { felt_.clear(); }

  core::TickFault read(core::HandState& hand) noexcept override;
  core::TickFault write(const core::Vec3& force_n) noexcept override;
  DeviceDetail detail() const noexcept override { return {force_n_}; }
  std::string description() const override { return "simulated hand"; }

 private:
  core::HandBody body_;
  double dt_s_;
  Memory memory_;
  core::StateTransition step_;
  TapPath path_{{}};
  std::int64_t ticks_{0};
  bool has_started_{false};
  core::HandState hand_;
  core::Vec3 force_n_{core::Vec3::Zero()};
  std::vector<FeltTick> felt_;
};
}  // namespace tapstudy::device
