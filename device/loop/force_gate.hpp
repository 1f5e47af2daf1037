#pragma once
#include <optional>

#include "core/settings/gate_settings.hpp"
namespace tapstudy::device {
struct PassedForce {
  core::Vec3 force_n;
  bool was_changed;
  core::TickFault fault;
};

// The one place that every force passes on its way to a device. It is armed first: nothing comes
// out until what is asked for has been small for some ticks, for a finger that rests inside a plate
// must not be thrown out; then force rises gently. What is no number, a hand too fast and a hand
// outside its workspace are faults, and no force. Size and rate are limited always.
class ForceGate {
 public:
  enum class State { armed, rendering, stopping, at_rest };
  ForceGate(const core::GateSettings& settings, double dt_s) noexcept;
  // elapsed_s: since the tick before. A position that jumps is a hand too fast, whatever velocity
  // the device tells: twice the limit, for a position's own error.
  PassedForce pass(const core::Vec3& wanted_n, const core::HandState& hand,
                   double elapsed_s) noexcept;
  // From now on force falls to none.
  void stop() noexcept;
  State state() const noexcept { return state_; }

 private:
  core::TickFault fault_of(const core::Vec3& wanted_n, const core::HandState& hand,
                           double elapsed_s) const noexcept;
  bool has_jumped(const core::Vec3& position_m, double elapsed_s) const noexcept;
  void advance(double wanted_size_n) noexcept;

  core::GateSettings settings_;
  double dt_s_;
  State state_;
  int quiet_ticks_{0};
  double share_{0.0};
  core::Vec3 previous_n_{core::Vec3::Zero()};
  std::optional<core::Vec3> previous_m_;
};
}  // namespace tapstudy::device
