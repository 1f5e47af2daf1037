#include "core/tick/actuator_voice.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "core/tick/modal_state.hpp"
#include "core/tick/state_transition.hpp"
namespace tapstudy::core {
namespace {
std::array<double, 3> plain(const Vec3& v) noexcept {
  return {v.x(), v.y(), v.z()};
}

// What the force of a mode, F = k q + b v, is per unit of displacement and of velocity, once it is
// turned and scaled by `by`. With w_d = w sqrt(1 - zeta²), y = (v + zeta w q) / w_d and the vector
// (q, y) = A e^(-zeta w t) (sin, cos)(w_d t):
//     F = c q + d y,   c = k - b zeta w,   d = b w_d,
// and turned by the angle p, sin and cos of w_d t + p take the place of those of w_d t. A
// mode that is critically damped or more does not turn.
std::pair<double, double> parts_of_force(double omega_rad_s, double damping_ratio,
                                         const Finger& finger, std::complex<double> by) {
  const double k = finger.stiffness_n_per_m;
  const double b = finger.damping_n_s_per_m;
  if (damping_ratio >= 1.0) {
    return {std::abs(by) * k, std::abs(by) * b};
  }
  const double decay = damping_ratio * omega_rad_s;
  const double turning = omega_rad_s * std::sqrt(1.0 - damping_ratio * damping_ratio);
  const double c = k - b * decay;
  const double d = b * turning;
  const double of_sine = c * by.real() - d * by.imag();
  const double of_cosine = c * by.imag() + d * by.real();
  return {of_sine + of_cosine * decay / turning, of_cosine / turning};
}
}  // namespace

ActuatorTick actuator_tick(const Contact& contact) noexcept {
  ActuatorTick tick{};
  tick.impact_speed_m_s = contact.impact_speed_m_s;
  tick.god_object_m = plain(contact.god_object_m);
  tick.normal = plain(contact.normal);
  tick.barycentric = contact.barycentric;
  tick.triangle = contact.triangle;
  tick.touching = contact.touching;
  tick.impact = contact.impact;
  return tick;
}

double passed_share(double rendered_n, double passed_n) noexcept {
  return rendered_n > 0.0 ? std::min(1.0, passed_n / rendered_n) : 1.0;
}

ActuatorVoice::ActuatorVoice(const VibratingPlate* plate,
                             std::span<const std::complex<double>> inverse,
                             const RenderSettings& settings, Transients transients, double sample_s)
    : plate_{plate}, mass_kg_{settings.finger.mass_kg}, transients_{std::move(transients)} {
  const Eigen::Index modes = plate == nullptr ? 0 : plate->model.frequency_hz.size();
  for (Eigen::ArrayXd* array : {&qq_, &qv_, &vq_, &vv_, &of_displacement_, &of_velocity_,
                                &displacement_, &velocity_, &before_, &touched_, &aim_, &step_}) {
    array->setZero(modes);
  }
  for (Eigen::Index i = 0; i < modes; ++i) {
    const double omega = 2.0 * std::numbers::pi * plate->model.frequency_hz[i];
    const double damping_ratio = plate->model.damping_ratio[i];
    const StateTransition step = exact_transition(omega, damping_ratio, sample_s);
    qq_[i] = step.qq;
    qv_[i] = step.qv;
    vq_[i] = step.vq;
    vv_[i] = step.vv;
    const auto [of_displacement, of_velocity] =
        parts_of_force(omega, damping_ratio, settings.finger, inverse[static_cast<std::size_t>(i)]);
    of_displacement_[i] = settings.vibration_gain * of_displacement;
    of_velocity_[i] = settings.vibration_gain * of_velocity;
  }
}

void ActuatorVoice::advance() noexcept {
  before_.swap(displacement_);
  displacement_ = qq_ * before_ + qv_ * velocity_;
  velocity_ = vq_ * before_ + vv_ * velocity_;
  if (++since_flush_ == ticks_to_flush) {
    flush(displacement_);
    flush(velocity_);
    since_flush_ = 0;
  }
  with_transients([](AddedForce& transient) { transient.advance(1); });
  if (left_ > 0) {
    touched_ += step_;
    share_ = --left_ == 0 ? share_aim_ : share_ + share_step_;
  }
}

void ActuatorVoice::begin(const ActuatorTick& tick, int samples) noexcept {
  const bool was_touching = std::exchange(is_touching_, tick.touching);
  if (!tick.touching) {
    pass(0.0, samples);
    return;
  }
  Contact contact;
  contact.god_object_m = Vec3::Map(tick.god_object_m.data());
  contact.normal = Vec3::Map(tick.normal.data());
  contact.barycentric = tick.barycentric;
  contact.triangle = tick.triangle;
  if (plate_ != nullptr) {
    modes_along(plate_->model, plate_->place_of(contact), contact.normal, aim_);
  }
  with_transients([&](AddedForce& transient) { transient.touch(contact); });
  if (!was_touching) {
    touched_ = aim_;
    share_ = tick.passed_share;
  }
  pass(tick.passed_share, samples);
  step_ = (aim_ - touched_) / samples;
  if (tick.impact) {
    velocity_ -= mass_kg_ * tick.impact_speed_m_s * aim_;  // eq. 14, 15
    with_transients([&](AddedForce& transient) { transient.impact(tick.impact_speed_m_s); });
  }
}

void ActuatorVoice::pass(double share, int samples) noexcept {
  share_aim_ = share;
  share_step_ = (share - share_) / samples;
  step_.setZero();
  left_ = samples;
}

double ActuatorVoice::force_n() const noexcept {
  ForceParts parts;
  if (transients_.sinusoid) {
    transients_.sinusoid->add_to(parts);
  }
  if (transients_.recorded) {
    transients_.recorded->add_to(parts);
  }
  const double vibration_n =
      (touched_ * (of_displacement_ * displacement_ + of_velocity_ * velocity_)).sum();
  return share_ * (vibration_n + parts.vibration_n + parts.sinusoid_n);
}

void ActuatorVoice::reset() noexcept {
  displacement_.setZero();
  velocity_.setZero();
  touched_.setZero();
  step_.setZero();
  with_transients([](AddedForce& transient) { transient.reset(); });
  share_ = share_step_ = share_aim_ = 0.0;
  left_ = 0;
  is_touching_ = false;
}

ActuatorLimiter::ActuatorLimiter(const ActuatorLimits& limits, double sample_s,
                                 double mean_square_n2) noexcept
    : limits_{limits}, kept_{std::exp(-sample_s)}, mean_square_n2_{mean_square_n2} {}

double ActuatorLimiter::limited(double force_n) noexcept {
  const double rms2 = limits_.rms_n * limits_.rms_n;
  const double room_n =
      std::isfinite(rms2) ? std::sqrt((rms2 - kept_ * mean_square_n2_) / (1.0 - kept_)) : rms2;
  const double most_n = std::min(limits_.peak_n, room_n);
  const double let_through_n = std::isfinite(force_n) ? std::clamp(force_n, -most_n, most_n) : 0.0;
  mean_square_n2_ =
      std::min(rms2, kept_ * mean_square_n2_ + (1.0 - kept_) * let_through_n * let_through_n);
  return let_through_n;
}
}  // namespace tapstudy::core
