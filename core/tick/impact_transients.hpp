#pragma once
#include <vector>

#include "core/settings/render_settings.hpp"
#include "core/tick/added_force.hpp"
namespace tapstudy::core {
// A decaying sinusoid at each impact (paper section 5.2.3), the same wherever the plate is tapped,
// or by the place.
class DecayingSinusoid final : public AddedForce {
 public:
  // phase_rad: of the sinusoid when it begins.
  DecayingSinusoid(const SinusoidShape& shape, double dt_s, double phase_rad = 0.0) noexcept
      : shape_{shape}, dt_s_{dt_s}, phase_rad_{phase_rad} {}
  void advance(int periods) noexcept override { age_s_ += periods * dt_s_; }
  void touch(const Contact& contact) noexcept override;
  void impact(double speed_m_s) noexcept override;
  void add_to(ForceParts& parts) const noexcept override { parts.sinusoid_n += force_n(); }
  void reset() noexcept override { amplitude_n_ = 0.0; }

 private:
  double force_n() const noexcept;

  SinusoidShape shape_;
  double dt_s_;
  double phase_rad_;
  double share_{0.0};  // of SinusoidShape::ByPlace, where it is touched
  double amplitude_n_{0.0};
  double frequency_hz_{0.0};
  double age_s_{0.0};
};

// Event-based playback (Kuchenbecker, Fiene & Niemeyer 2006): at each impact a measured transient,
// of the tap whose place is nearest and, of several there, whose speed is; in proportion to the
// impact's speed. A new impact ends the one before.
class RecordedTransient final : public AddedForce {
 public:
  // Sampled at the rate of the loop; at least one tap.
  RecordedTransient(std::vector<RecordedTap> taps, double gain)
      : taps_{std::move(taps)}, gain_{gain} {}
  void advance(int periods) noexcept override { tick_ += static_cast<std::size_t>(periods); }
  void touch(const Contact& contact) noexcept override { at_m_ = contact.god_object_m.head<2>(); }
  void impact(double speed_m_s) noexcept override;
  void add_to(ForceParts& parts) const noexcept override;
  void reset() noexcept override { played_ = nullptr; }

 private:
  bool is_nearer(const RecordedTap& one, const RecordedTap& other, double speed_m_s) const noexcept;

  std::vector<RecordedTap> taps_;
  double gain_;
  Eigen::Vector2d at_m_{Eigen::Vector2d::Zero()};
  const RecordedTap* played_{nullptr};
  double scale_{0.0};
  std::size_t tick_{0};  // since the impact
};
}  // namespace tapstudy::core
