#pragma once
#include <Eigen/Core>

#include "core/haptics/haptic_state.hpp"
#include "core/model/modal_model.hpp"
#include "core/tick/state_transition.hpp"
#include "core/tick/vibrating_plate.hpp"
namespace tapstudy::core {
// The displacement of a point of the surface along the normal, per unit of each modal coordinate
// (paper eq. 16). `along` has an entry per mode.
void modes_along(const ModalModel& model, const SurfacePoint& point, const Vec3& normal,
                 Eigen::ArrayXd& along) noexcept;

// A decaying state is set to zero before it becomes denormal, where arithmetic is slow. The
// smallest relevant motion is some eighty orders of magnitude larger. Every `ticks_to_flush` is
// soon enough: a mode that falls from there to denormal numbers in so few ticks is gone in the
// next.
inline constexpr int ticks_to_flush = 64;
void flush(Eigen::ArrayXd& values) noexcept;

// The dynamic state of a plate: one displacement and one velocity per mode (paper eq. 11). The
// model must outlive it. Only the constructor allocates.
class ModalState {
 public:
  ModalState(const ModalModel& model, Integrator integrator, double dt_s);

  // Sets the contact point and its outward normal (plate frame, unit length).
  void touch(const SurfacePoint& point, const Vec3& normal) noexcept;
  // An impulse at the contact point along the normal, outwards positive [N s]: each modal velocity
  // jumps by its component of P' p (paper eq. 11, 15).
  void strike(double impulse_n_s) noexcept;
  void tick() noexcept;
  // Adds to the tick just made the response to a force at the contact point along the normal
  // [N, outwards positive] that was held throughout it: HeldForceResponse, one per mode.
  void push(double force_n) noexcept;
  void reset() noexcept;

  // Motion at the contact point along the normal, outwards positive (paper eq. 16, 17).
  double displacement_m() const noexcept;
  double velocity_m_s() const noexcept;
  // The displacement there before the last tick.
  double previous_displacement_m() const noexcept;
  // The increase of displacement_m() for each newton pushed.
  double compliance_m_per_n() const noexcept;
  // Energy of the whole plate: kinetic plus elastic.
  double energy_j() const noexcept;

 private:
  const ModalModel* model_;
  Eigen::ArrayXd qq_, qv_, vq_, vv_;  // StateTransition, one per mode
  Eigen::ArrayXd held_q_, held_v_;    // HeldForceResponse
  Eigen::ArrayXd displacement_, velocity_, previous_;
  int since_flush_{0};      // ticks
  Eigen::ArrayXd touched_;  // the touched point's displacement along the normal, per mode
};
}  // namespace tapstudy::core
