#pragma once
#include <optional>
#include <vector>

#include "analysis/modal/modes/repeated_modes.hpp"
namespace tapstudy::analysis {
// A tone that does not decay, such as hum, as a sensor shows it while nothing else rings.
struct SteadyTone {
  double frequency_hz{};
  double amplitude{};
  double phase_rad{};  // middle_s after the first sample of the stretch that shows it
  double middle_s{};
  double frequency_error_hz{};
  double amplitude_error{};

  // Of its value so long after the stretch's first sample.
  double error_at(double t_s) const;
};

// The strongest tone within reach of a frequency, 8 standard errors above what else is there, and
// known to fall or rise by no more than a third over the stretch and what has passed since the last
// blow before it, of which a mode may still ring (struck_s; 0: there was none); unset if there is
// none, or if the stretch is shorter than shortest_stretch_s or ten periods.
inline constexpr double shortest_stretch_s = 0.15;
std::optional<SteadyTone> steady_tone(const FreeDecay& stretch, double near_hz, double reach_hz,
                                      double struck_s = 0.0);

// Samples that begin so long after the stretch, without the tone.
void take_tone(const SteadyTone& tone, double begins_s, FreeDecay& decay);

// Within this distance a decay of this length does not tell a tone from a mode: the half-power
// bandwidth, or half of the decay's own resolution.
double tone_reach_hz(const RepeatedMode& mode, double decay_s);

// What a sensor shows beside a tap while nothing else rings, and when the tap's decay begins after
// the first sample of that.
struct QuietStretch {
  FreeDecay samples;
  double decay_begins_s{};
  double struck_s{};  // from the last blow before the stretch to its first sample; 0: none
};

// One tone near a mode, tap by tap; unset where a tap's stretch does not show it.
struct ToneOfTaps {
  double frequency_hz{};  // the medians
  double amplitude{};     // 0: not known
  std::vector<std::optional<SteadyTone>> of_taps;
  std::vector<double> errors;  // where a decay begins; 0 where a fit of the decay has to find it
};

// Unset unless half of the stretches in which the mode would fall by e show it, and it has at least
// a thousandth of the mode's amplitude: an unknown tone of a share e of it shifts the mode's pole
// by up to 4 e of its decay rate (least squares of c exp(s t) over a long decay).
std::optional<ToneOfTaps> tone_near(const RepeatedMode& mode,
                                    const std::vector<QuietStretch>& stretches, double reach_hz);

// Those of agreed modes, and of doubtful ones that are stronger, each once. Unless half of the
// stretches show that there is none, also harmonics of the mains within 1 Hz of a mode, of which
// other harmonics are among the lines.
std::vector<ToneOfTaps> tones_in(const std::vector<RepeatedMode>& modes,
                                 const std::vector<QuietStretch>& stretches, double decay_s);

// Modes that lie so near tones that were taken out of the decays: their intervals become wider by
// what the tones' errors may do, and the reason says so.
void tell_of_tones(const std::vector<ToneOfTaps>& tones, double decay_s,
                   std::vector<RepeatedMode>& modes);
}  // namespace tapstudy::analysis
