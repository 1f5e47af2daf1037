#pragma once
#include <optional>

#include "analysis/modal_identification/free_decay.hpp"
namespace tapstudy::analysis {
// One damped oscillation as fitted: Re(c z^n) = amplitude e^(-decay t) cos(w t + phase).
struct FittedMode {
  Pole pole;
  double amplitude{};  // at the first sample
  double phase_rad{};
  // Standard errors, of white noise in the band
  double frequency_error_hz{};
  double ratio_error{};
  double decay_error_per_s{};
  double amplitude_error{};
  double phase_error_rad{};
  double significance{};  // chi-squared of the amplitude's two parts, 2 degrees of freedom
};

struct DecayFit {
  std::vector<FittedMode> modes;  // as many as poles were given, in their order
  double noise{};                 // standard deviation of a sample, from the residual in the band
  double explained{};             // share of the band's energy
  double degrees_of_freedom{};
  bool has_converged{};
  Eigen::VectorXcd fitted;  // the spectrum's values by the modes and the nuisance terms
};

// Maximum likelihood in white noise from these poles on: variable projection (Golub & Pereyra 1973,
// Kaufman's approximation) with Levenberg-Marquardt steps on the poles. The transform of a damped
// exponential cut off after N samples, (1 - z^N) / (1 - z q), q = e^(-jw), is exact: a rectangular
// window leaks nothing that is not in the model. A drift 1 / (1 - q) and 1, q, q^2 take up what
// modes outside the band leave in it. Standard errors are those of the Cramer-Rao bound, with the
// noise of the residual. Steady lines of these frequencies, such as hum, take part with amplitudes
// alone. Throws InvalidInput for more unknowns than values.
DecayFit fit_decay(const BandSpectrum& spectrum, const std::vector<Pole>& start,
                   const std::vector<double>& lines_hz = {});
}  // namespace tapstudy::analysis
