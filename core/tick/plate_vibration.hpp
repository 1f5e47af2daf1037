#pragma once
#include "core/settings/render_settings.hpp"
#include "core/tick/added_force.hpp"
#include "core/tick/coupled_finger.hpp"
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
  void advance(int periods) noexcept override;
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

// A finger that stays on the vibrating body during the tap: CoupledFinger on all modes at the
// god-object, whose contact is as stiff as the penalty spring. What the hand feels of it takes the
// place of the penalty force K (g - h) at the body's rest shape: the force added is the difference
// of the two, so that at rest on a body that does not give way it is zero, as with every technique.
// The finger exists while the hand touches; before, it moves as the hand does. Over periods that
// were missed the hand is taken to have moved at constant speed, and the contact acts all the
// while. Free modes only: their vibration_gain is not used, because a scaled reaction would not be
// passive.
class CoupledVibration final : public AddedForce {
 public:
  // The plate must outlive it.
  CoupledVibration(const VibratingPlate& plate, const RenderSettings& settings);
  void advance(int periods) noexcept override;
  void touch(const Contact& contact) noexcept override;
  // The impact is the contact force itself.
  void impact(double /*speed_m_s*/) noexcept override {}
  void add_to(ForceParts& parts) const noexcept override;
  void reset() noexcept override;
  double energy_j() const noexcept override { return state_.energy_j(); }
  // Modes, and while it touches the finger, its spring and the contact: what never grows by more
  // than the work of the hand (CoupledFinger).
  double coupled_energy_j() const noexcept;

 private:
  void press(double hand_m) noexcept;

  const VibratingPlate* plate_;
  double dt_s_;
  ModalState state_;
  double penalty_stiffness_n_per_m_;
  CoupledFinger finger_;
  bool is_touching_{false};
  bool was_touching_{false};  // one tick ago
  int behind_{0};             // periods by which the modes have yet to advance
};
}  // namespace tapstudy::core
