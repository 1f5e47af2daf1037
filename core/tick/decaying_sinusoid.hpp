#pragma once
namespace tapstudy::core {
// A e^(-decay t) sin(2 pi frequency t), A proportional to the tapping speed (paper section 5.2.3,
// after Okamura et al. 1998).
struct SinusoidShape {
  double amplitude_n_s_per_m{};  // A per speed of impact
  double decay_per_s{600.0};
  double frequency_hz{250.0};
};

class DecayingSinusoid {
 public:
  explicit DecayingSinusoid(const SinusoidShape& shape) noexcept : shape_{shape} {}
  void strike(double speed_m_s) noexcept;
  double force_n() const noexcept;
  void tick(double dt_s) noexcept { age_s_ += dt_s; }
  void reset() noexcept { amplitude_n_ = 0.0; }

 private:
  SinusoidShape shape_;
  double amplitude_n_{0.0};
  double age_s_{0.0};
};
}  // namespace tapstudy::core
