#pragma once
#include <Eigen/Core>

#include "core/tick/state_transition.hpp"
namespace tapstudy::runner {
// Force time series [N]: one row per tick, one column per tapping point.
using Forces = Eigen::ArrayXXd;

// The frequency of the integrated mode: Newmark's is 2 atan(omega dt / 2) / dt, undamped.
Eigen::ArrayXd numerical_frequency_hz(const Eigen::ArrayXd& frequency_hz,
                                      core::Integrator integrator, double rate_hz);

// The largest relative frequency error below the band limit, both ascending, mode by mode: the nth
// mode of a mesh converges to the nth of the body (Courant's minimax principle). A mode that the
// mesh shifts beyond the band counts as if it lay at the limit.
double frequency_error(const Eigen::ArrayXd& reference_hz, const Eigen::ArrayXd& found_hz,
                       double band_limit_hz);

// |found - reference| / |reference| in the L2 norm, maximum over the tapping points.
double force_error(const Forces& reference, const Forces& found);

// The difference in RMS level [dB], of largest magnitude over the tapping points.
double level_error_db(const Forces& reference, const Forces& found);

// Gain of the zero-order hold at a frequency: |sinc(f dt)|.
Eigen::ArrayXd held_gain(const Eigen::ArrayXd& frequency_hz, double rate_hz);
}  // namespace tapstudy::runner
