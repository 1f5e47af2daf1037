#pragma once
#include <span>
#include <vector>
namespace tapstudy::analysis {
// An exponential sweep, repeated, with silence after each (Farina 2000, Simultaneous measurement of
// impulse response and distortion with a swept-sine technique, AES 108th Convention, Paris,
// preprint 5093): with L = ln(f2/f1) and T its duration
//   x(t) = sin(2 pi f1 T / L (e^(t L / T) - 1)),
// which begins and ends along half a period of a cosine, within an octave of its ends. Divided by
// its spectrum, what a system's nonlinearity adds comes before the linear impulse response, and is
// cut off there.
struct SweptSine {
  double rate_hz{};
  double from_hz{};  // the band that is measured; the sweep begins and ends beyond it
  double to_hz{};
  double seconds{};  // of one sweep
  int repeats{};     // at least 2
};
inline constexpr double silence_after_sweep_s = 0.5;

// Samples between -1 and 1. Throws InvalidInput where the sweep would go beyond what the rate
// plays, or is too short to resolve its lowest frequency.
std::vector<double> samples_of(const SweptSine& sweep);

struct ResponsePoint {
  double frequency_hz{};
  double gain{};
  double phase_rad{};  // not wrapped
  double coherence{};  // of the repeats, 0 to 1
};
struct SweptResponse {
  std::vector<ResponsePoint> points;  // evenly over the logarithm of frequency, in the band
  double delay_s{};                   // from the recording's begin to the first sweep's sound
};

// What a system made of the sweep: recorded over commanded, at so many frequencies. Where the
// command was recorded as well, `reference`, the phase is against it, whatever its scale; else
// against the largest value of the impulse response, whose delay is unknown. With H_k the response
// to the sweep k of n, the coherence is |sum H_k|^2 / (n sum |H_k|^2), that of equal excitations
// (Bendat & Piersol 2010, Random Data, 4th ed., section 6.2); of noise alone it is 1/n on average.
// Throws InvalidInput if the recording is shorter than the sweeps.
SweptResponse response_to(const SweptSine& sweep, std::span<const double> recorded,
                          std::span<const double> reference, int points);
}  // namespace tapstudy::analysis
