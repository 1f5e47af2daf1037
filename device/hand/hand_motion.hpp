#pragma once
#include <optional>
#include <vector>

#include "core/haptics/haptic_state.hpp"
#include "core/settings/device_settings.hpp"
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

// One voluntary tap: position, speed, depth of the muscle's aim, dwell time. Device frame; taps go
// down (-y).
struct PlannedTap {
  core::Vec3 point_m{core::Vec3::Zero()};  // on the surface
  double speed_m_s{0.3};                   // > 0
  double hover_m{0.02};                    // starts and ends this high above the surface
  double run_up_m{0.01};                   // of hover_m, to accelerate; 0: at speed from start
  double press_m{0.004};                   // the muscle's aim below the surface
  double dwell_s{0.2};
  double pause_s{0.3};  // after lifting, while moving to the next point
};

struct Target {
  core::Vec3 position_m{core::Vec3::Zero()};
  core::Vec3 velocity_m_s{core::Vec3::Zero()};
};

// Trajectory of the muscle's aim during a series of taps: constant acceleration, then down at
// constant speed, dwell, lift and travel to the next point along a minimum-jerk path (Flash & Hogan
// 1985). After the last tap the aim rests above its point.
class TapPath {
 public:
  // Starts at from_m, the hand's present position, or above the first point if unset; without taps
  // it rests there, or in the middle of the workspace.
  explicit TapPath(std::vector<PlannedTap> taps, std::optional<core::Vec3> from_m = {});
  Target at(double t_s) const noexcept;
  double duration_s() const noexcept { return starts_s_.back(); }

 private:
  std::vector<PlannedTap> taps_;
  std::optional<core::Vec3> from_m_;
  std::vector<double> starts_s_;  // of each tap, and the end
};
}  // namespace tapstudy::device
