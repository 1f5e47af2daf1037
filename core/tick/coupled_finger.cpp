#include "core/tick/coupled_finger.hpp"

#include <algorithm>
#include <cmath>
namespace tapstudy::core {
namespace {
double frequency_rad_s(const Finger& finger) noexcept {
  return std::sqrt(finger.stiffness_n_per_m / finger.mass_kg);
}
double damping_ratio(const Finger& finger) noexcept {
  return finger.damping_n_s_per_m / (2.0 * finger.mass_kg * frequency_rad_s(finger));
}

// The positive root of a c² + b c = d, without cancellation; a > 0, d >= 0.
double positive_root(double a, double b, double d) noexcept {
  const double root = std::sqrt(b * b + 4.0 * a * d);
  if (b <= 0.0) {
    return (root - b) / (2.0 * a);
  }
  return 2.0 * d / (b + root);
}
}  // namespace

CoupledFinger::CoupledFinger(const Finger& finger, double contact_stiffness_n_per_m,
                             double dt_s) noexcept
    : finger_{finger},
      contact_stiffness_n_per_m_{contact_stiffness_n_per_m},
      dt_s_{dt_s},
      step_{exact_transition(frequency_rad_s(finger), damping_ratio(finger), dt_s)},
      per_newton_{held_force_response(Integrator::exact, frequency_rad_s(finger),
                                      damping_ratio(finger), dt_s)} {
  per_newton_.q /= finger.mass_kg;
  per_newton_.v /= finger.mass_kg;
}

void CoupledFinger::begin(double hand_m, double hand_velocity_m_s, double surface_m) noexcept {
  hand_m_ = hand_m;
  offset_m_ = 0.0;
  yield_m_ = std::max(0.0, surface_m - hand_m);
  velocity_m_s_ = hand_velocity_m_s;
}

double CoupledFinger::tick(double hand_m, const SurfaceTick& surface) noexcept {
  const double compression_m = surface.before_m - hand_m_ - offset_m_ - yield_m_;
  const double hand_velocity_m_s = (hand_m - hand_m_) / dt_s_;
  const double relative_m_s = velocity_m_s_ - hand_velocity_m_s;
  const double unloaded_m = step_.qq * offset_m_ + step_.qv * relative_m_s;
  const double contact_n =
      held_contact_force_n(compression_m, surface.unloaded_m - hand_m - unloaded_m - yield_m_,
                           surface.compliance_m_per_n + per_newton_.q, contact_stiffness_n_per_m_);
  const double velocity_m_s = hand_velocity_m_s + step_.vq * offset_m_ + step_.vv * relative_m_s +
                              per_newton_.v * contact_n;
  force_on_hand_n_ = contact_n - finger_.mass_kg * (velocity_m_s - velocity_m_s_) / dt_s_;
  offset_m_ = unloaded_m + per_newton_.q * contact_n;
  velocity_m_s_ = velocity_m_s;
  hand_m_ = hand_m;
  const double surface_m = surface.unloaded_m - surface.compliance_m_per_n * contact_n;
  yield_m_ = std::clamp(surface_m - hand_m_ - offset_m_, 0.0, yield_m_);
  return contact_n;
}

double CoupledFinger::energy_j(double surface_m) const noexcept {
  const double compression_m = std::max(0.0, surface_m - hand_m_ - offset_m_ - yield_m_);
  return 0.5 * (finger_.mass_kg * velocity_m_s_ * velocity_m_s_ +
                finger_.stiffness_n_per_m * offset_m_ * offset_m_ +
                contact_stiffness_n_per_m_ * compression_m * compression_m);
}

double held_contact_force_n(double compression_before_m, double unloaded_compression_m,
                            double compliance_m_per_n, double stiffness_n_per_m) noexcept {
  const double before = compression_before_m;
  const double unloaded = unloaded_compression_m;
  if (before <= 0.0 && unloaded <= 0.0) {
    return 0.0;
  }
  const double half = 0.5 * stiffness_n_per_m;
  if (before < 0.0) {  // contact begins: c (g1 - g0) = K g1² / 2, the root with g1 > 0
    const double gain = stiffness_n_per_m * unloaded * compliance_m_per_n;
    const double apart = unloaded - before;
    const double root = std::sqrt(apart * apart - 2.0 * gain * before);
    return stiffness_n_per_m * unloaded * unloaded / (apart + gain + root);
  }
  const double held = half * (before + unloaded) / (1.0 + half * compliance_m_per_n);
  if (unloaded >= compliance_m_per_n * held) {
    return held;
  }
  // contact ends: c (g0 - g1) = K g0² / 2
  return positive_root(compliance_m_per_n, before - unloaded, half * before * before);
}
}  // namespace tapstudy::core
