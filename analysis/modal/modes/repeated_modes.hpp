#pragma once
#include <optional>

#include "analysis/modal/decay/estimate.hpp"
#include "analysis/modal/modes/tap_modes.hpp"
namespace tapstudy::analysis {
// How a mode that follows its amplitude begins in a tap: the medians over taps.
struct AtTap {
  double frequency_hz{};
  double damping_ratio{};
};

// One mode, as several taps show it.
struct RepeatedMode {
  Estimate frequency_hz;
  Estimate damping_ratio;
  double degrees_of_freedom{};  // of their standard errors
  // The probability (chi-squared) that the standard errors explain the scatter of the frequency
  // over three or more taps. It is small where two modes are too close to be resolved.
  std::optional<double> scatter_p{};
  Standing standing{Standing::doubtful};
  std::string why;
  double amplitude{};  // at the beginning of a decay, the median over taps that show it
  std::optional<AtTap>
      at_tap;    // set: it follows its amplitude, and the estimates are those at rest
  int taps{};    // that show it
  int agreed{};  // of these, with both methods
};

// Modes of different taps are one if their frequencies differ by 2 % at most (a sixth of the
// half-power bandwidth or four standard errors if that is more); each tap shows one at most, and of
// several close ones each the nearest, all together. A mode is agreed if at least half of the taps
// that show it say so, and, of several impacts, two do, and its estimates are of these taps alone;
// or if the rational fit finds it in two thirds of all taps (three at least) at ten times
// min_significance.
// Ascending frequency. impacts: of each tap the number of its impact, where several channels show
// the same one: what they say is averaged, since they vary together. Empty: each tap is an impact
// of its own.
std::vector<RepeatedMode> modes_over_taps(const std::vector<TapModes>& taps,
                                          const std::vector<int>& impacts = {});
}  // namespace tapstudy::analysis
