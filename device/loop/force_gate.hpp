#pragma once
#include <optional>

#include "core/settings/device_settings.hpp"
namespace tapstudy::device {
struct PassedForce {
  core::Vec3 force_n;
  bool was_changed;
  core::TickFault fault;
};

// The safety stage that every force passes before it reaches a device. It starts armed: the output
// stays zero until the requested force has been small for 10 ms, so that a finger resting
// inside a plate is not thrown out; then the force is ramped up. A non-finite value, excessive hand
// speed and a position outside the workspace are faults and give zero force. Magnitude and rate are
// always limited.
class ForceGate {
 public:
  enum class State { armed, rendering, stopping, at_rest };
  ForceGate(const core::GateSettings& settings, double dt_s) noexcept;
  // elapsed_s: since the previous tick. A jump in position counts as excessive speed, whatever
  // velocity the device reports: at twice the limit, to allow for position error.
  // max_share: of the wanted force in this tick; force rises again from there.
  PassedForce pass(const core::Vec3& wanted_n, const core::HandState& hand, double elapsed_s,
                   double max_share = 1.0) noexcept;
  // Force rises again from nothing, as at the beginning: after a gap in which nobody knows what the
  // hand did.
  void rise_again() noexcept;
  // Starts the ramp down to zero force.
  void stop() noexcept;
  State state() const noexcept { return state_; }
  // Less than the wanted force passes, since rise_again or a max_share below 1.
  bool is_rising_again() const noexcept { return is_rising_again_; }

 private:
  core::TickFault fault_of(const core::Vec3& wanted_n, const core::HandState& hand,
                           double elapsed_s) const noexcept;
  bool has_jumped(const core::Vec3& position_m, double elapsed_s) const noexcept;
  void advance(double wanted_size_n) noexcept;
  void fall_to(double max_share) noexcept;

  core::GateSettings settings_;
  double dt_s_;
  State state_;
  double quiet_s_{0.0};
  double share_{0.0};
  bool is_rising_again_{false};
  core::Vec3 previous_n_{core::Vec3::Zero()};
  std::optional<core::Vec3> previous_m_;
};
}  // namespace tapstudy::device
