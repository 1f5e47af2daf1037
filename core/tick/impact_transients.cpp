#include "core/tick/impact_transients.hpp"

#include <cmath>
#include <numbers>
namespace tapstudy::core {
namespace {
constexpr double silent_exponent = 30.0;  // e^-30 of the amplitude is below any device's resolution
}

void DecayingSinusoid::touch(const Contact& contact) noexcept {
  if (shape_.by_place) {
    share_ = shape_.by_place->share_at(contact.god_object_m.x(), contact.god_object_m.y());
  }
}

void DecayingSinusoid::impact(double speed_m_s) noexcept {
  amplitude_n_ = shape_.amplitude_n_s_per_m * speed_m_s;
  frequency_hz_ = shape_.frequency_hz;
  age_s_ = 0.0;
  if (shape_.by_place) {
    amplitude_n_ *= 1.0 + share_ * (shape_.by_place->amplitude_factor - 1.0);
    frequency_hz_ *= 1.0 + share_ * (shape_.by_place->frequency_factor - 1.0);
  }
}

double DecayingSinusoid::force_n() const noexcept {
  const double exponent = shape_.decay_per_s * age_s_;
  if (amplitude_n_ == 0.0 || exponent > silent_exponent) {
    return 0.0;
  }
  return amplitude_n_ * std::exp(-exponent) *
         std::sin(2.0 * std::numbers::pi * frequency_hz_ * age_s_ + phase_rad_);
}

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
