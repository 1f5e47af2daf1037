#include "device/hand/muscle_body.hpp"

#include <cmath>
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
}  // namespace tapstudy::device
