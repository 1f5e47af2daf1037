#pragma once
#include <limits>
#include <string>
#include <vector>

#include "core/settings/render_settings.hpp"
namespace tapstudy::core {
// A vibration actuator beside the force device, a voice coil for instance, on a channel of a sound
// card.
//
// What it makes of a command: the force on the finger over the force commanded.
struct ActuatorResponse {
  DeviceResponse magnitude;       // at least one point
  std::vector<double> phase_rad;  // of each of its points; linear over the logarithm of frequency
  // Of an ideal actuator, whose force is the command.
  static ActuatorResponse flat() { return {{{{1.0, 1.0}}, 1.0}, {0.0}}; }
};

struct ActuatorLimits {
  double peak_n{std::numeric_limits<double>::infinity()};
  // Root of the mean square with weights e^(-t/τ), τ = 1 s: what heats a coil.
  double rms_n{std::numeric_limits<double>::infinity()};
};

struct ActuatorOutput {
  std::string card;  // name of an ALSA PCM
  int rate_hz{48000};
  int channel{1};         // of `channels`, from 1
  int channels{2};        // that are opened; the others are silent
  double full_scale_n{};  // the force at full scale
  ActuatorLimits limits;
  double max_delay_s{0.004};  // from a tick to its sound
  int max_gaps{3};            // of the card in a trial, each of which spoils at most one tap
  ActuatorResponse response;
};
}  // namespace tapstudy::core
