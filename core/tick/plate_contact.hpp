#pragma once
#include "core/tick/contact.hpp"
namespace tapstudy::core {
// The upper face of a plate, in the plate frame: z = 0, |x| and |y| within these.
struct PlateFace {
  double half_x_m{};
  double half_y_m{};
};

// The god-object (Zilles & Salisbury 1995) on a flat plate's upper face: where the haptic
// interaction point would be if it could not penetrate.
//
// Contact begins when the tip crosses the face downwards and ends when it rises above it or slides
// over the edge. A tip found below the face without having crossed it (the first reading, or a
// finger coming from the side) is not in contact, which avoids a sudden force.
//
// Contact chatter does not retrigger impacts: after an impact the next one is armed only once the
// tip has been higher than release_height_m.
class PlateContact {
 public:
  PlateContact(const PlateFace& face, double release_height_m) noexcept
      : face_{face}, release_height_m_{release_height_m} {}
  const Contact& tick(const HandState& tip) noexcept;
  const Contact& now() const noexcept { return contact_; }
  ContactHistory history() const noexcept { return history_; }
  // Takes over the contact history of the previous renderer.
  void continue_from(const ContactHistory& history) noexcept;

 private:
  PlateFace face_;
  double release_height_m_;
  Contact contact_;
  ContactHistory history_;
};
}  // namespace tapstudy::core
