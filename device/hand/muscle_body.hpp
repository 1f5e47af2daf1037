#pragma once
#include "core/haptic_state.hpp"
#include "core/settings/hand_body.hpp"
#include "core/tick/state_transition.hpp"
namespace tapstudy::device {
// The unforced motion of hand and muscle over dt about a fixed aim.
core::StateTransition muscle_transition(const core::HandBody& body, double dt_s) noexcept;

// A hand on its muscle: m x'' = k (a - x) + b (a' - x') + f. The force f and the speed of the
// muscle's aim a are held during a tick; the motion is integrated exactly.
class MuscleBody {
 public:
  MuscleBody(const core::HandBody& body, double dt_s);
  const core::HandState& state() const noexcept { return state_; }
  void place(const core::HandState& state) noexcept { state_ = state; }
  // One tick, in which the aim goes from here to there.
  void move(const core::Vec3& aim_m, const core::Vec3& next_aim_m,
            const core::Vec3& force_n) noexcept;

 private:
  double muscle_stiffness_n_per_m_;
  double dt_s_;
  core::StateTransition step_;
  core::HandState state_;
};
}  // namespace tapstudy::device
