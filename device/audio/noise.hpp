#pragma once
#include <cstdint>
#include <vector>

#include "core/random/rng.hpp"
#include "core/settings/audio_settings.hpp"
#include "device/audio/pcm.hpp"
namespace tapstudy::device {
// A digital filter of second order, in the transposed direct form II.
class Biquad {
 public:
  struct Coefficients {
    double b0{1.0}, b1{}, b2{}, a1{}, a2{};  // a0 is 1
  };
  explicit Biquad(const Coefficients& coefficients) : c_{coefficients} {}
  double filtered(double x) noexcept {
    const double y = c_.b0 * x + s1_;
    s1_ = c_.b1 * x - c_.a1 * y + s2_;
    s2_ = c_.b2 * x - c_.a2 * y;
    return y;
  }

 private:
  Coefficients c_;
  double s1_{};
  double s2_{};
};
using Cascade = std::vector<Biquad>;

inline double filtered(Cascade& cascade, double x) noexcept {
  for (Biquad& biquad : cascade) {
    x = biquad.filtered(x);
  }
  return x;
}

// -3 dB per octave above 10 Hz: real poles an octave apart with a zero half an octave above each
// (Keshner 1982; Smith & Smith 2016, arXiv:1606.06154), mapped by z = e^(s T). At 48 kHz within
// 0.4 dB from 20 Hz to 12 kHz, and 0.9 dB too strong at 19 kHz.
Cascade pink_filter(double rate_hz);
// Butterworth high-pass and low-pass of fourth order, by the bilinear transform (Bristow-Johnson,
// Audio EQ Cookbook): -3 dB at the edges, 24 dB an octave beyond. 0 < low_hz < high_hz < half the
// rate.
Cascade band_filter(double low_hz, double high_hz, double rate_hz);

// RMS of the output for white noise of RMS 1: the root of the energy of the impulse response, which
// is followed for one second.
double noise_gain(Cascade cascade, double rate_hz);

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
