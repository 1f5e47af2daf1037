#pragma once
#include <string>
namespace tapstudy::core {
// The sound card of a rig.
struct AudioOutput {
  std::string card{"default"};  // name of an ALSA PCM
  int rate_hz{48000};
  double gain_db{0.0};  // calibration, added to the level that a protocol asks for
};
}  // namespace tapstudy::core
