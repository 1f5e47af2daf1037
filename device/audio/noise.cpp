#include "device/audio/noise.hpp"

#include <array>
#include <cmath>
#include <numbers>
namespace tapstudy::device {
namespace {
using std::numbers::pi;
using std::numbers::sqrt2;
constexpr double first_pole_hz = 10.0;
// 1 / (2 cos(pi/8)) and 1 / (2 cos(3 pi/8)): the pole pairs of a Butterworth filter of order 4
constexpr std::array butterworth_q{0.541196100146197, 1.306562964876377};

enum class Pass { low, high };
Biquad pass(Pass side, double edge_hz, double q, double rate_hz) {
  const double w = 2.0 * pi * edge_hz / rate_hz;
  const double alpha = std::sin(w) / (2.0 * q);
  const double a0 = 1.0 + alpha;
  const double b1 = side == Pass::low ? 1.0 - std::cos(w) : -(1.0 + std::cos(w));
  const double b0 = 0.5 * std::abs(b1);
  return Biquad{{b0 / a0, b1 / a0, b0 / a0, -2.0 * std::cos(w) / a0, (1.0 - alpha) / a0}};
}
}  // namespace

Cascade pink_filter(double rate_hz) {
  const auto image_of = [&](double hz) { return std::exp(-2.0 * pi * hz / rate_hz); };
  Cascade cascade;
  for (double pole_hz = first_pole_hz; pole_hz < 0.5 * rate_hz; pole_hz *= 2.0) {
    const double zero_hz = sqrt2 * pole_hz;
    const double zero = zero_hz < 0.5 * rate_hz ? image_of(zero_hz) : 0.0;
    cascade.emplace_back(Biquad::Coefficients{1.0, -zero, 0.0, -image_of(pole_hz), 0.0});
  }
  return cascade;
}

Cascade band_filter(double low_hz, double high_hz, double rate_hz) {
  Cascade cascade;
  for (const double q : butterworth_q) {
    cascade.push_back(pass(Pass::high, low_hz, q, rate_hz));
    cascade.push_back(pass(Pass::low, high_hz, q, rate_hz));
  }
  return cascade;
}

double noise_gain(Cascade cascade, double rate_hz) {
  double energy = 0.0;
  double x = 1.0;
  for (double t_s = 0.0; t_s < 1.0; t_s += 1.0 / rate_hz) {
    const double y = filtered(cascade, x);
    energy += y * y;
    x = 0.0;
  }
  return std::sqrt(energy);
}

namespace {
Cascade filter_of(const core::MaskingNoise& noise, double rate_hz) {
  switch (noise.kind) {
    case core::NoiseKind::white:
      return {};
    case core::NoiseKind::pink:
      return pink_filter(rate_hz);
    case core::NoiseKind::band:
      return band_filter(noise.low_hz, noise.high_hz, rate_hz);
  }
  return {};
}
}  // namespace

Noise::Noise(const core::MaskingNoise& noise, double rate_hz, std::uint64_t seed)
    : rng_{seed},
      filter_{filter_of(noise, rate_hz)},
      scale_{std::pow(10.0, noise.level_db_fs / 20.0) / noise_gain(filter_, rate_hz)} {}

void Noise::fill(std::span<float> samples) noexcept {
  for (float& sample : samples) {
    sample = static_cast<float>(scale_ * filtered(filter_, rng_.normal()));
  }
}
}  // namespace tapstudy::device
