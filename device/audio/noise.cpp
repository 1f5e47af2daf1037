#include "device/audio/noise.hpp"

#include <cmath>
namespace tapstudy::device {
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
