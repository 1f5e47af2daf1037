#pragma once
namespace tapstudy::core {
// One tick of an unloaded damped oscillator q'' + 2 zeta omega q' + omega² q = 0, as a matrix on
// (displacement q, velocity v):   q' = qq q + qv v,   v' = vq q + vv v.
struct OscillatorStep {
  double qq;
  double qv;
  double vq;
  double vv;
};
enum class Integrator { exact, newmark };

// The closed-form solution over dt, right for under-, critical and over-damping. omega > 0 [rad/s],
// damping_ratio >= 0, dt > 0.
OscillatorStep exact_step(double omega_rad_s, double damping_ratio, double dt_s) noexcept;

// Newmark 1959 with beta = 1/4, gamma = 1/2 (the paper, section 4.2.1): never gains energy, but
// rings at 2 atan(omega dt / 2) / dt instead of omega when undamped.
OscillatorStep newmark_step(double omega_rad_s, double damping_ratio, double dt_s) noexcept;

OscillatorStep oscillator_step(Integrator integrator, double omega_rad_s, double damping_ratio,
                               double dt_s) noexcept;
}  // namespace tapstudy::core
