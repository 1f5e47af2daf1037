#pragma once
#include "core/settings/render_settings.hpp"
#include "core/tick/added_force.hpp"
#include "core/tick/modal_state.hpp"
#include "core/tick/vibrating_plate.hpp"
namespace tapstudy::core {
// The plate's own vibration, felt through the finger's spring and damper (paper eq. 16, 17).
//
// Impact. The finger loses the momentum p = -m (n.v) n (eq. 14); by Newton's third law the plate
// receives the opposite, along the finger's motion, distributed to the nodes by the shape functions
// at the god-object (eq. 15).
class PlateVibration final : public AddedForce {
 public:
  // The plate must outlive it.
  PlateVibration(const VibratingPlate& plate, const RenderSettings& settings);
  void advance() noexcept override { state_.tick(); }
  void touch(const Contact& contact) noexcept override;
  void impact(double speed_m_s) noexcept override;
  void add_to(ForceParts& parts) const noexcept override;
  void reset() noexcept override { state_.reset(); }
  double energy_j() const noexcept override { return state_.energy_j(); }

 private:
  const VibratingPlate* plate_;
  Finger finger_;
  double gain_;
  ModalState state_;
};
}  // namespace tapstudy::core
