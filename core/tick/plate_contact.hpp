#pragma once
#include "core/haptic_state.hpp"
namespace tapstudy::core {
// What the contact is this tick, in the plate frame.
struct Contact {
  bool touching{false};
  bool struck{false};  // an impact that excites the plate: true in one tick only
  double penetration_m{0.0};
  double impact_speed_m_s{0.0};  // speed into the plate, in the tick of the impact
  Vec3 god_object_m{Vec3::Zero()};
};

// The god-object (Zilles & Salisbury 1995) of a flat plate's upper face, z = 0, |x|, |y| within the
// half sizes: where the finger would rest if it could not enter.
//
// A contact begins where the tip passes the face downwards and ends where it rises out of it or
// slides over the edge. A tip that is found below the face without having passed it (the first
// reading, or a finger coming from the side) is not in contact: no force may appear from nowhere.
//
// Chatter does not strike again: after an impact the plate is struck anew only once the tip has
// been higher than release_height_m.
class PlateContact {
 public:
  PlateContact(double half_x_m, double half_y_m, double release_height_m) noexcept
      : half_x_m_{half_x_m}, half_y_m_{half_y_m}, release_height_m_{release_height_m} {}
  const Contact& tick(const HandState& tip) noexcept;
  const Contact& now() const noexcept { return contact_; }
  // Knows where the finger came from as the other did; neither is touching.
  void continue_from(const PlateContact& other) noexcept;

 private:
  double half_x_m_;
  double half_y_m_;
  double release_height_m_;
  Contact contact_;
  bool was_above_{false};
  bool may_strike_{false};
};
}  // namespace tapstudy::core
