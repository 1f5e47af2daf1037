#pragma once
#include <string>
namespace tapstudy::core {
// The sound card of a rig.
struct AudioOutput {
  std::string card{"default"};  // name of an ALSA PCM
  int rate_hz{48000};
  double gain_db{0.0};  // calibration, added to the level that a protocol asks for
};

// white: the same power in every hertz; pink: in every octave; band: white between two edges
enum class NoiseKind { white, pink, band };

// Noise for the participant's ears while a plate is rendered, so that the device is not heard.
struct MaskingNoise {
  NoiseKind kind{NoiseKind::white};
  double level_db_fs{};  // RMS, where 0 is an RMS of full scale
  double low_hz{};       // of band only
  double high_hz{};
  double ramp_s{0.5};       // in and out
  bool is_required{false};  // without a card there is no session
};

// Noise has no highest sample: louder, and more than 1 in 15 000 of them would be cut.
inline constexpr double max_noise_level_db_fs = -12.0;
}  // namespace tapstudy::core
