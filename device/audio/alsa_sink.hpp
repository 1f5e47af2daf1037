#pragma once
#include <memory>
#include <string>

#include "device/audio/pcm.hpp"
namespace tapstudy::device {
struct AlsaSettings {
  std::string card;  // name of a PCM: "default", "hw:CARD=PCH,DEV=0", "plughw:1" …
  int rate_hz{48000};
  double period_s{0.01};
  int periods{8};  // in the card's buffer
};

// A PCM of ALSA: 32 or 16 bits, two channels where it has them, with the same samples in each.
// Throws DeviceError if the card cannot be opened, is in use, or refuses the rate.
std::unique_ptr<PcmSink> open_alsa(const AlsaSettings& settings);
}  // namespace tapstudy::device
