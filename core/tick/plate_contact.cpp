#include "core/tick/plate_contact.hpp"

#include <algorithm>
#include <cmath>
namespace tapstudy::core {
const Contact& PlateContact::tick(const HandState& tip) noexcept {
  const Vec3& at = tip.position_m;
  const bool is_over = std::abs(at.x()) <= half_x_m_ && std::abs(at.y()) <= half_y_m_;
  const bool is_below = at.z() < 0.0;
  const bool enters = !contact_.touching && was_above_ && is_below && is_over;
  contact_.touching = (contact_.touching || enters) && is_below && is_over;
  contact_.struck = enters && may_strike_;
  contact_.impact_speed_m_s = contact_.struck ? std::max(0.0, -tip.velocity_m_s.z()) : 0.0;
  contact_.penetration_m = contact_.touching ? -at.z() : 0.0;
  contact_.god_object_m = contact_.touching ? Vec3{at.x(), at.y(), 0.0} : at;
  may_strike_ = !contact_.struck && (may_strike_ || at.z() > release_height_m_);
  was_above_ = !is_below;
  return contact_;
}

void PlateContact::continue_from(const PlateContact& other) noexcept {
  contact_ = {};
  was_above_ = other.was_above_;
  may_strike_ = other.may_strike_;
}
}  // namespace tapstudy::core
