#pragma once
#include <Eigen/Core>

#include "core/tick/state_transition.hpp"
namespace tapstudy::runner {
// Forces [N] in time: a row a tick, a column a tapping point.
using Forces = Eigen::ArrayXXd;

// At which frequency a mode really rings: Newmark's is 2 atan(omega dt / 2) / dt, undamped.
Eigen::ArrayXd numerical_frequency_hz(const Eigen::ArrayXd& frequency_hz,
                                      core::Integrator integrator, double rate_hz);

// The largest relative error of a mode below the band limit, both ascending, mode by mode: the nth
// of a mesh converges to the nth of the body (Courant's minimax principle). A mode that the mesh
// has lost to beyond the band counts as if it lay at the limit.
double frequency_error(const Eigen::ArrayXd& reference_hz, const Eigen::ArrayXd& found_hz,
                       double band_limit_hz);

// |found - reference| / |reference| in the L2 norm, of the tapping point where it is largest.
double force_error(const Forces& reference, const Forces& found);

// The difference in root mean square [dB], of the tapping point where it is largest in size.
double level_error_db(const Forces& reference, const Forces& found);

// What is left of a frequency in an output that is held from tick to tick: |sinc(f dt)|.
Eigen::ArrayXd held_gain(const Eigen::ArrayXd& frequency_hz, double rate_hz);
}  // namespace tapstudy::runner
