#include "core/tick/plate_contact.hpp"

#include <algorithm>
#include <cmath>
namespace tapstudy::core {
namespace {
// A point on the edge stays there through the placement's arithmetic.
constexpr double rounding_m = 1e-9;
}  // namespace

const Contact& PlateContact::tick(const HandState& tip) noexcept {
  const Vec3& at = tip.position_m;
  const bool was_above = history_.has_tip && history_.tip_m.z() >= 0.0;
  const bool is_over = std::abs(at.x()) <= face_.half_x_m + rounding_m &&
                       std::abs(at.y()) <= face_.half_y_m + rounding_m;
  const bool is_below = at.z() < 0.0;
  const bool enters = !contact_.touching && was_above && is_below && is_over;
  contact_.touching = (contact_.touching || enters) && is_below && is_over;
  contact_.impact = enters && history_.impact_armed;
  contact_.impact_speed_m_s = contact_.impact ? std::max(0.0, -tip.velocity_m_s.z()) : 0.0;
  contact_.penetration_m = contact_.touching ? -at.z() : 0.0;
  contact_.normal_velocity_m_s = contact_.touching ? tip.velocity_m_s.z() : 0.0;
  contact_.god_object_m = contact_.touching ? Vec3{at.x(), at.y(), 0.0} : at;
  history_.impact_armed = !contact_.impact && (history_.impact_armed || at.z() > release_height_m_);
  history_.tip_m = at;
  history_.has_tip = true;
  return contact_;
}

void PlateContact::continue_from(const ContactHistory& history) noexcept {
  contact_ = {};
  history_ = history;
}
}  // namespace tapstudy::core
