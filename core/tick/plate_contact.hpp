#pragma once
#include "core/tick/contact.hpp"
namespace tapstudy::core {
// The upper face of a plate, in the plate frame: z = 0, |x| and |y| within these.
struct PlateFace {
  double half_x_m{};
  double half_y_m{};
};

// The god-object (Zilles & Salisbury 1995) of a flat plate's upper face: where the finger would
// rest if it could not enter.
//
// A contact begins where the tip passes the face downwards and ends where it rises out of it or
// slides over the edge. A tip that is found below the face without having passed it (the first
// reading, or a finger coming from the side) is not in contact: no force may appear from nowhere.
//
// Chatter does not strike again: after an impact the plate is struck anew only once the tip has
// been higher than release_height_m.
class PlateContact {
 public:
  PlateContact(const PlateFace& face, double release_height_m) noexcept
      : face_{face}, release_height_m_{release_height_m} {}
  const Contact& tick(const HandState& tip) noexcept;
  const Contact& now() const noexcept { return contact_; }
  ContactHistory history() const noexcept { return history_; }
  // Knows where the finger came from, as whoever rendered it before did.
  void continue_from(const ContactHistory& history) noexcept;

 private:
  PlateFace face_;
  double release_height_m_;
  Contact contact_;
  ContactHistory history_;
};
}  // namespace tapstudy::core
