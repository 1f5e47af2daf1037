#include "device/hand/hand_motion.hpp"

#include <algorithm>
#include <cmath>

#include "core/haptics/haptic_state.hpp"
namespace tapstudy::device {
core::StateTransition muscle_transition(const core::HandBody& body, double dt_s) noexcept {
  const double omega = std::sqrt(body.muscle_stiffness_n_per_m / body.mass_kg);
  const double ratio = body.muscle_damping_n_s_per_m / (2.0 * body.mass_kg * omega);
  return core::exact_transition(omega, ratio, dt_s);
}

MuscleBody::MuscleBody(const core::HandBody& body, double dt_s)
    : muscle_stiffness_n_per_m_{body.muscle_stiffness_n_per_m},
      dt_s_{dt_s},
      step_{muscle_transition(body, dt_s)} {}

// In coordinates moving with the aim, a constant force shifts the equilibrium position.
void MuscleBody::move(const core::Vec3& aim_m, const core::Vec3& next_aim_m,
                      const core::Vec3& force_n) noexcept {
  const core::Vec3 drift_m_s = (next_aim_m - aim_m) / dt_s_;
  const core::Vec3 rest_m = force_n / muscle_stiffness_n_per_m_;
  const core::Vec3 offset_m = state_.position_m - aim_m - rest_m;
  const core::Vec3 relative_m_s = state_.velocity_m_s - drift_m_s;
  state_.position_m = next_aim_m + rest_m + step_.qq * offset_m + step_.qv * relative_m_s;
  state_.velocity_m_s = drift_m_s + step_.vq * offset_m + step_.vv * relative_m_s;
}

namespace {
using core::Vec3;
const Vec3 up{Vec3::Unit(core::normal_axis)};

Vec3 above(const PlannedTap& tap) noexcept {
  return tap.point_m + tap.hover_m * up;
}
double run_up_s(const PlannedTap& tap) noexcept {
  return 2.0 * tap.run_up_m / tap.speed_m_s;
}
double approach_s(const PlannedTap& tap) noexcept {
  return run_up_s(tap) + (tap.hover_m - tap.run_up_m + tap.press_m) / tap.speed_m_s;
}
double duration_of(const PlannedTap& tap) noexcept {
  return approach_s(tap) + tap.dwell_s + tap.pause_s;
}

Target approaching(const PlannedTap& tap, double t_s) noexcept {
  const double gathering = run_up_s(tap);
  const double gathered = gathering > 0.0 ? std::min(t_s / gathering, 1.0) : 1.0;
  const double after = std::max(0.0, t_s - gathering);
  const double fallen_m = tap.run_up_m * gathered * gathered + tap.speed_m_s * after;
  return {tap.point_m + (tap.hover_m - fallen_m) * up, -tap.speed_m_s * gathered * up};
}

// Minimum jerk: s(u) = 10 u³ - 15 u⁴ + 6 u⁵ for u from 0 to 1.
Target travelling(const Vec3& from, const Vec3& to, double t_s, double duration_s) noexcept {
  const double u = duration_s > 0.0 ? std::clamp(t_s / duration_s, 0.0, 1.0) : 1.0;
  const double path = u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
  const double rate = duration_s > 0.0 ? 30.0 * u * u * (1.0 - u) * (1.0 - u) / duration_s : 0.0;
  return {from + path * (to - from), rate * (to - from)};
}
}  // namespace

TapPath::TapPath(std::vector<PlannedTap> taps, std::optional<Vec3> from_m)
    : taps_{std::move(taps)}, from_m_{std::move(from_m)} {
  starts_s_.push_back(from_m_ && !taps_.empty() ? taps_.front().pause_s : 0.0);
  for (const PlannedTap& tap : taps_) {
    starts_s_.push_back(starts_s_.back() + duration_of(tap));
  }
}

Target TapPath::at(double t_s) const noexcept {
  if (taps_.empty()) {
    return {from_m_.value_or(Vec3::Zero()), Vec3::Zero()};
  }
  if (t_s < starts_s_.front()) {
    return travelling(*from_m_, above(taps_.front()), t_s, starts_s_.front());
  }
  const auto next = std::upper_bound(starts_s_.begin(), starts_s_.end() - 1, t_s);
  const auto index = static_cast<std::size_t>(
      std::max<std::ptrdiff_t>(0, std::distance(starts_s_.begin(), next) - 1));
  const PlannedTap& tap = taps_[index];
  double left_s = t_s - starts_s_[index];
  if (left_s < approach_s(tap)) {
    return approaching(tap, left_s);
  }
  left_s -= approach_s(tap);
  const Vec3 pressed = tap.point_m - tap.press_m * up;
  if (left_s < tap.dwell_s) {
    return {pressed, Vec3::Zero()};
  }
  const PlannedTap& following = taps_[std::min(index + 1, taps_.size() - 1)];
  return travelling(pressed, above(following), left_s - tap.dwell_s, tap.pause_s);
}
}  // namespace tapstudy::device
