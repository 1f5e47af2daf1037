#pragma once
#include <cstdint>

#include "core/rng.hpp"
#include "core/settings/masking_noise.hpp"
#include "device/audio/noise_filters.hpp"
#include "device/audio/sample_source.hpp"
namespace tapstudy::device {
// Gaussian noise of a colour and a level; the same seed gives the same samples.
class Noise final : public SampleSource {
 public:
  // noise.level_db_fs: the RMS that is played, calibration included.
  Noise(const core::MaskingNoise& noise, double rate_hz, std::uint64_t seed);
  void fill(std::span<float> samples) noexcept override;

 private:
  core::Rng rng_;
  Cascade filter_;
  double scale_;
};
}  // namespace tapstudy::device
