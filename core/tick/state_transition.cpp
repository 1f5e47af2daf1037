#include "core/tick/state_transition.hpp"

#include <cmath>
namespace tapstudy::core {
namespace {
constexpr double small_step = 1e-3;  // five terms of a series suffice for all digits below it

StateTransition underdamped_transition(double omega, double zeta, double dt) noexcept {
  const double decay_rate = zeta * omega;
  const double damped = omega * std::sqrt((1.0 - zeta) * (1.0 + zeta));
  const double envelope = std::exp(-decay_rate * dt);
  const double angle = damped * dt;
  const double cosine = envelope * std::cos(angle);
  const double sine_over_damped = envelope * (angle > 0.0 ? std::sin(angle) / damped : dt);
  return {cosine + decay_rate * sine_over_damped, sine_over_damped,
          -omega * omega * sine_over_damped, cosine - decay_rate * sine_over_damped};
}

// Two real exponentials, slow and fast. Formulated to avoid cancellation: near critical damping the
// rates nearly coincide, far above it one of them is nearly zero.
StateTransition overdamped_transition(double omega, double zeta, double dt) noexcept {
  const double root = std::sqrt((zeta - 1.0) * (zeta + 1.0));
  const double half_gap = omega * root;
  const double slow_rate = omega / (zeta + root);
  const double fast_rate = omega * (zeta + root);
  const double slow = std::exp(-slow_rate * dt);
  const double fast = std::exp(-fast_rate * dt);
  const double qv =
      half_gap * dt > 0.0 ? slow * -std::expm1(-2.0 * half_gap * dt) / (2.0 * half_gap) : slow * dt;
  const double vv =
      root > 0.1 ? (fast_rate * fast - slow_rate * slow) / (2.0 * half_gap) : slow - fast_rate * qv;
  return {slow + slow_rate * qv, qv, -omega * omega * qv, vv};
}
}  // namespace

StateTransition exact_transition(double omega_rad_s, double damping_ratio, double dt_s) noexcept {
  return damping_ratio < 1.0 ? underdamped_transition(omega_rad_s, damping_ratio, dt_s)
                             : overdamped_transition(omega_rad_s, damping_ratio, dt_s);
}

// Newmark's method with beta = 1/4 and gamma = 1/2 is the trapezoidal rule on (q, v), solved for
// q', v'.
StateTransition newmark_transition(double omega_rad_s, double damping_ratio, double dt_s) noexcept {
  const double damping = damping_ratio * omega_rad_s * dt_s;
  const double stiffness = 0.25 * omega_rad_s * omega_rad_s * dt_s * dt_s;
  const double denominator = 1.0 + damping + stiffness;
  return {(1.0 + damping - stiffness) / denominator, dt_s / denominator,
          -omega_rad_s * omega_rad_s * dt_s / denominator,
          (1.0 - damping - stiffness) / denominator};
}

StateTransition state_transition(Integrator integrator, double omega_rad_s, double damping_ratio,
                                 double dt_s) noexcept {
  return integrator == Integrator::exact ? exact_transition(omega_rad_s, damping_ratio, dt_s)
                                         : newmark_transition(omega_rad_s, damping_ratio, dt_s);
}

HeldForceResponse held_force_response(Integrator integrator, double omega_rad_s,
                                      double damping_ratio, double dt_s) noexcept {
  const StateTransition step = state_transition(integrator, omega_rad_s, damping_ratio, dt_s);
  if (integrator == Integrator::newmark) {
    return {0.5 * dt_s * step.qv, step.qv};
  }
  const double damping = 2.0 * damping_ratio * omega_rad_s * dt_s;
  const double stiffness = omega_rad_s * omega_rad_s * dt_s * dt_s;
  if (damping + stiffness > small_step) {
    return {(1.0 - step.qq) / (omega_rad_s * omega_rad_s), step.qv};
  }
  // Taylor's series: 1 - qq would cancel
  const double third = -damping / 6.0;
  const double fourth = (damping * damping - stiffness) / 24.0;
  const double fifth = damping * (2.0 * stiffness - damping * damping) / 120.0;
  return {dt_s * dt_s * (0.5 + third + fourth + fifth), step.qv};
}
}  // namespace tapstudy::core
