#pragma once
#include <vector>

#include "core/tick/oscillator_step.hpp"
#include "device/device.hpp"
#include "device/tap_path.hpp"
namespace tapstudy::device {
// Finger, grip and device as one mass on a muscle's spring and damper.
struct HandBody {
  double mass_kg{0.1};
  double muscle_stiffness_n_per_m{400.0};
  double muscle_damping_n_s_per_m{9.0};
};

// The motion of hand and muscle over dt round a fixed aim, as long as nothing pushes.
core::OscillatorStep muscle_step(const HandBody& body, double dt_s) noexcept;

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
  SimulatedHand(const HandBody& body, double dt_s, Memory memory);

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
  HandBody body_;
  double dt_s_;
  Memory memory_;
  core::OscillatorStep step_;
  TapPath path_{{}};
  std::int64_t ticks_{0};
  bool has_started_{false};
  core::HandState hand_;
  core::Vec3 force_n_{core::Vec3::Zero()};
  std::vector<FeltTick> felt_;
};
}  // namespace tapstudy::device
