#pragma once
#include <memory>
#include <optional>
#include <string>

#include "device/audio/pcm.hpp"
namespace tapstudy::device {
struct AlsaSettings {
  std::string card;  // name of a PCM: "default", "hw:CARD=PCH,DEV=0", "plughw:1" …
  int rate_hz{48000};
  double period_s{0.01};
  int periods{8};                     // in the card's buffer
  int channels{2};                    // as near to it as the card has
  std::optional<int> only_channel{};  // from 0; the others are silent. Unset: all play the same
};

// A PCM of ALSA: 32 or 16 bits.
// Throws DeviceError if the card cannot be opened, is in use, refuses the rate, or does not have
// the channel.
std::unique_ptr<PcmSink> open_alsa(const AlsaSettings& settings);
}  // namespace tapstudy::device
