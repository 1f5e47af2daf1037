#pragma once
#include <optional>
#include <vector>

#include "analysis/modal/decay/estimate.hpp"
#include "analysis/modal/decay/free_decay.hpp"
namespace tapstudy::analysis {
// amplitude e^(-decay t) sin(2 pi frequency t), t from start_s on (the paper, 5.2.3).
struct FittedSinusoid {
  double amplitude{};  // above 0: the sensor may point either way
  double decay_per_s{};
  double frequency_hz{};
  double start_s{};          // after the first sample; where the sine passes 0 nearest to it
  double amplitude_error{};  // standard errors, of white noise
  double decay_error_per_s{};
  double frequency_error_hz{};
  double explained{};  // share of the energy about the mean
};

// Least squares of the samples from an impact on, with an offset: the best of a grid of decays and
// frequencies in the band, refined by Levenberg-Marquardt (MINPACK's, by Eigen). At most the first
// 4000 samples are used. Unset if no oscillation comes out of it: the frequency left the band, or
// nothing decays. Throws InvalidInput for fewer than 16 samples.
std::optional<FittedSinusoid> fit_decaying_sinusoid(const FreeDecay& from_impact, const Band& band);

// amplitude = slope * speed by least squares through the origin, with Student's t interval; of one
// tap no interval can be had: it is infinite. As many speeds as amplitudes, at least one, above 0.
// Throws InvalidInput otherwise.
Estimate amplitude_per_speed(const std::vector<double>& speeds_m_s,
                             const std::vector<double>& amplitudes);

// amplitude = offset + slope * speed by least squares, with Student's t intervals: whether the law
// above holds. Unset for fewer than three taps, and for taps of one speed. Throws InvalidInput as
// above.
struct AmplitudeLine {
  Estimate offset;
  Estimate slope;
  bool is_proportional() const { return offset.interval.low <= 0.0 && offset.interval.high >= 0.0; }
};
std::optional<AmplitudeLine> amplitude_line(const std::vector<double>& speeds_m_s,
                                            const std::vector<double>& amplitudes);
}  // namespace tapstudy::analysis
