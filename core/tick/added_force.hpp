#pragma once
#include "core/haptics/haptic_state.hpp"
#include "core/tick/contact.hpp"
namespace tapstudy::core {
// A part of the feedback force that a technique adds to the penalty force (paper eq. 18). The
// renderer calls advance() first in each tick; then, while the finger touches, touch(), impact() in
// the tick of an impact, and add_to(). Constructors allocate; nothing else does.
class AddedForce {
 public:
  virtual ~AddedForce() = default;
  // Advances by this many periods of the loop: 1, and one more for each missed since the last tick.
  virtual void advance(int periods) noexcept = 0;
  // Sets the god-object's position; force is rendered along the contact normal.
  virtual void touch(const Contact& contact) noexcept = 0;
  // The finger hit the surface at this speed.
  virtual void impact(double speed_m_s) noexcept = 0;
  virtual void add_to(ForceParts& parts) const noexcept = 0;
  // Back to the state of rest.
  virtual void reset() noexcept = 0;
  // Kinetic plus elastic energy of the vibrating body.
  virtual double energy_j() const noexcept { return 0.0; }
};
}  // namespace tapstudy::core
