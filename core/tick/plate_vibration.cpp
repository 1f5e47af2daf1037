#include "core/tick/plate_vibration.hpp"

#include <algorithm>

namespace tapstudy::core {
PlateVibration::PlateVibration(const VibratingPlate& plate, const RenderSettings& settings)
    : plate_{&plate},
      finger_{settings.finger},
      gain_{settings.vibration_gain},
      state_{plate.model, settings.integrator, settings.dt_s} {}

void PlateVibration::advance(int periods) noexcept {
  for (; periods > 0; --periods) {
    state_.tick();
  }
}

void PlateVibration::touch(const Contact& contact) noexcept {
  state_.touch(plate_->place_of(contact), contact.normal);  // eq. 16
}

void PlateVibration::impact(double speed_m_s) noexcept {
  state_.strike(-finger_.mass_kg * speed_m_s);  // eq. 14, 15
}

void PlateVibration::add_to(ForceParts& parts) const noexcept {
  parts.vibration_n += gain_ * (finger_.stiffness_n_per_m * state_.displacement_m() +
                                finger_.damping_n_s_per_m * state_.velocity_m_s());  // eq. 17
}

CoupledVibration::CoupledVibration(const VibratingPlate& plate, const RenderSettings& settings)
    : plate_{&plate},
      dt_s_{settings.dt_s},
      state_{plate.model, settings.integrator, settings.dt_s},
      penalty_stiffness_n_per_m_{settings.penalty_stiffness_n_per_m},
      finger_{settings.finger,
              contact_stiffness_beside(settings.finger, settings.penalty_stiffness_n_per_m),
              settings.dt_s} {}

// In contact the periods that were missed wait for touch(), which knows where the hand is now. If
// the finger has lifted meanwhile, they are made up for in the next tick: nobody feels the modes
// until then.
void CoupledVibration::advance(int periods) noexcept {
  was_touching_ = is_touching_;
  is_touching_ = false;
  behind_ += periods;
  for (const int left = was_touching_ ? behind_ - 1 : 0; behind_ > left; --behind_) {
    state_.tick();
  }
}

void CoupledVibration::touch(const Contact& contact) noexcept {
  is_touching_ = true;
  state_.touch(plate_->place_of(contact), contact.normal);
  const double hand_m = -contact.penetration_m;
  if (!was_touching_) {
    // it was not inside yet, whatever the device says of its speed
    const double hand_before_m = std::max(0.0, hand_m - dt_s_ * contact.normal_velocity_m_s);
    finger_.begin(hand_before_m, contact.normal_velocity_m_s, state_.previous_displacement_m());
  }
  const double step_m = (hand_m - finger_.hand_m()) / (behind_ + 1);
  for (; behind_ > 0; --behind_) {
    press(hand_m - behind_ * step_m);
    state_.tick();
  }
  press(hand_m);
}

void CoupledVibration::press(double hand_m) noexcept {
  const SurfaceTick surface{state_.previous_displacement_m(), state_.displacement_m(),
                            state_.compliance_m_per_n()};
  state_.push(-finger_.tick(hand_m, surface));
}

void CoupledVibration::add_to(ForceParts& parts) const noexcept {
  parts.vibration_n += finger_.force_on_hand_n() + penalty_stiffness_n_per_m_ * finger_.hand_m();
}

void CoupledVibration::reset() noexcept {
  state_.reset();
  is_touching_ = false;
  was_touching_ = false;
  behind_ = 0;
}

double CoupledVibration::coupled_energy_j() const noexcept {
  return state_.energy_j() + (is_touching_ ? finger_.energy_j(state_.displacement_m()) : 0.0);
}
}  // namespace tapstudy::core
