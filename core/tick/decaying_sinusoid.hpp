#pragma once
#include "core/settings/render_settings.hpp"
#include "core/tick/added_force.hpp"
namespace tapstudy::core {
// A decaying sinusoid at each impact (paper section 5.2.3), the same wherever the plate is tapped,
// or by the place.
class DecayingSinusoid final : public AddedForce {
 public:
  explicit DecayingSinusoid(const RenderSettings& settings) noexcept
      : shape_{settings.sinusoid}, dt_s_{settings.dt_s} {}
  void advance() noexcept override { age_s_ += dt_s_; }
  void touch(const Contact& contact) noexcept override;
  void impact(double speed_m_s) noexcept override;
  void add_to(ForceParts& parts) const noexcept override { parts.sinusoid_n += force_n(); }
  void reset() noexcept override { amplitude_n_ = 0.0; }

 private:
  double force_n() const noexcept;

  SinusoidShape shape_;
  double dt_s_;
  double share_{0.0};  // of SinusoidShape::ByPlace, where it is touched
  double amplitude_n_{0.0};
  double frequency_hz_{0.0};
  double age_s_{0.0};
};
}  // namespace tapstudy::core
