#include "core/tick/plate_vibration.hpp"
namespace tapstudy::core {
PlateVibration::PlateVibration(const VibratingPlate& plate, const RenderSettings& settings)
    : plate_{&plate},
      finger_{settings.finger},
      gain_{settings.vibration_gain},
      state_{plate.model, settings.integrator, settings.dt_s} {}

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
}  // namespace tapstudy::core
