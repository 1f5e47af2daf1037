#pragma once
#include "core/settings/render_settings.hpp"
namespace tapstudy::core {
// The state transition matrix over one tick of an unloaded damped oscillator, one mode of paper
// eq. 11: q'' + 2 zeta omega q' + omega² q = 0, as a matrix on
// (displacement q, velocity v):   q' = qq q + qv v,   v' = vq q + vv v.
struct StateTransition {
  double qq;
  double qv;
  double vq;
  double vv;
};

// The closed-form solution over dt for under-, critical and over-damping. omega > 0 [rad/s],
// damping_ratio >= 0, dt > 0.
StateTransition exact_transition(double omega_rad_s, double damping_ratio, double dt_s) noexcept;

// Newmark 1959 with beta = 1/4, gamma = 1/2 (the paper, section 4.2.1): never gains energy, but
// oscillates at 2 atan(omega dt / 2) / dt instead of omega when undamped (period elongation).
StateTransition newmark_transition(double omega_rad_s, double damping_ratio, double dt_s) noexcept;

StateTransition state_transition(Integrator integrator, double omega_rad_s, double damping_ratio,
                                 double dt_s) noexcept;

// The contribution to (q, v) of a unit force held over the tick, q'' + 2 zeta omega q' + omega² q =
// 1: the same transition about the equilibrium 1 / omega² instead of 0, so q = (1 - qq) / omega²
// and v = -vq / omega² = qv. omega >= 0.
//
// Law. If the transition never gains energy E = (v² + omega² q²) / 2, as with both integrators,
// then neither does the energy about the shifted equilibrium, which is to say that a held force f
// adds no more than its work: E' - E <= f (q' - q). With exact_transition the difference is what
// the damper took.
struct HeldForceResponse {
  double q;
  double v;
};
HeldForceResponse held_force_response(Integrator integrator, double omega_rad_s,
                                      double damping_ratio, double dt_s) noexcept;
}  // namespace tapstudy::core
