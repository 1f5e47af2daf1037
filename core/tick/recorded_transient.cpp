#include "core/tick/recorded_transient.hpp"

#include <cmath>
namespace tapstudy::core {
bool RecordedTransient::is_nearer(const RecordedTap& one, const RecordedTap& other,
                                  double speed_m_s) const noexcept {
  constexpr double same_place_m2 = 1e-12;
  const double one_m2 = (one.at_m - at_m_).squaredNorm();
  const double other_m2 = (other.at_m - at_m_).squaredNorm();
  if (std::abs(one_m2 - other_m2) > same_place_m2) {
    return one_m2 < other_m2;
  }
  const auto difference = [speed_m_s](const RecordedTap& tap) {
    return std::abs(std::log(tap.speed_m_s / speed_m_s));
  };
  return difference(one) < difference(other);
}

void RecordedTransient::impact(double speed_m_s) noexcept {
  played_ = taps_.data();
  for (const RecordedTap& tap : taps_) {
    if (is_nearer(tap, *played_, speed_m_s)) {
      played_ = &tap;
    }
  }
  scale_ = gain_ * speed_m_s / played_->speed_m_s;
  tick_ = 0;
}

void RecordedTransient::add_to(ForceParts& parts) const noexcept {
  if (played_ != nullptr && tick_ < played_->force_n.size()) {
    parts.vibration_n += scale_ * played_->force_n[tick_];
  }
}
}  // namespace tapstudy::core
