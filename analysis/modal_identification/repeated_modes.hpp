#pragma once
#include <optional>

#include "analysis/modal_identification/tap_modes.hpp"
#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// A value with its 95 % interval.
struct Estimate {
  double value{};
  double standard_error{};            // over taps, not below what their noise alone gives
  Interval interval;                  // Student's t: over taps, or of one tap's noise
  std::optional<Interval> bootstrap;  // over taps, bias-corrected and accelerated, of 5 and more
};

// Of one tap: the value and its standard error with so many degrees of freedom. Of several: their
// mean, and the interval over taps. Values and errors as many, at least one.
Estimate estimate_over_taps(const std::vector<double>& values, const std::vector<double>& errors,
                            double degrees_of_freedom_of_one);

// One mode, as several taps show it.
struct RepeatedMode {
  Estimate frequency_hz;
  Estimate damping_ratio;
  double degrees_of_freedom{};  // of their standard errors
  // Of the frequencies' scatter over three taps or more: the probability that their own errors
  // explain as much (chi-squared). Two modes that are too close to be told apart make it small.
  std::optional<double> scatter_p{};
  Standing standing{Standing::doubtful};
  std::string why;
  int taps{};                          // that show it
  int agreed{};                        // of these, with both methods
  std::vector<double> frequencies_hz;  // of each impact that shows it, mean over its channels
  std::vector<double> ratios;
};

// Modes of different taps are one if their frequencies differ by 2 % at most (a third of the
// half-power bandwidth or four standard errors if that is more); each tap shows one at most, and of
// several close ones each the nearest, all together. A mode is agreed if at least half of the taps
// that show it say so, and, of several taps, two do; its estimates are of these taps alone.
// Ascending frequency. impacts: of each tap the number of its impact, where several channels show
// the same one: what they say is averaged, since they vary together. Empty: each tap is an impact
// of its own.
std::vector<RepeatedMode> modes_over_taps(const std::vector<TapModes>& taps,
                                          const std::vector<int>& impacts = {});
}  // namespace tapstudy::analysis
