#include "core/tick/plate_contact.hpp"

#include <algorithm>
#include <cmath>
namespace tapstudy::core {
const Contact& PlateContact::tick(const HandState& tip) noexcept {
  const Vec3& at = tip.position_m;
  const bool was_above = approach_.has_tip && approach_.tip_m.z() >= 0.0;
  const bool is_over = std::abs(at.x()) <= face_.half_x_m && std::abs(at.y()) <= face_.half_y_m;
  const bool is_below = at.z() < 0.0;
  const bool enters = !contact_.touching && was_above && is_below && is_over;
  contact_.touching = (contact_.touching || enters) && is_below && is_over;
  contact_.struck = enters && approach_.may_strike;
  contact_.impact_speed_m_s = contact_.struck ? std::max(0.0, -tip.velocity_m_s.z()) : 0.0;
  contact_.penetration_m = contact_.touching ? -at.z() : 0.0;
  contact_.god_object_m = contact_.touching ? Vec3{at.x(), at.y(), 0.0} : at;
  approach_.may_strike = !contact_.struck && (approach_.may_strike || at.z() > release_height_m_);
  approach_.tip_m = at;
  approach_.has_tip = true;
  return contact_;
}

void PlateContact::continue_from(const Approach& approach) noexcept {
  contact_ = {};
  approach_ = approach;
}
}  // namespace tapstudy::core
