#pragma once
#include <Eigen/Core>
#include <memory>

#include "core/model/elements/assembly.hpp"
#include "core/model/modes/shifted_factor.hpp"
#include "core/model/progress.hpp"
namespace tapstudy::core {
// The natural modes of (K, M) from above zero up to a band limit: the solutions X of
// (-w² M + K) X = 0 (paper eq. 7). A vibration x = X e^(wt) with Rayleigh damping has the same
// shapes (eq. 4 to 6), so damping need not be known here.
struct Modes {
  Eigen::ArrayXd omega_rad_s;  // ascending; undamped natural angular frequencies
  Eigen::MatrixXd
      shapes;  // one column per mode, M-orthonormal [kg^-1/2], sign fixed: the paper's P (eq. 8)
  int rigid_body_modes{0};       // at zero frequency, left out
  Eigen::MatrixXd rigid_shapes;  // theirs, M-orthonormal
  int counted_in_band{0};        // by the inertia of K - sigma M, rigid-body modes included
  double worst_residual{0.0};    // max over modes of |K x - w² M x| / (|K x| + w² |M x|)
  double factor_s{0.0};
  double iterate_s{0.0};
  std::shared_ptr<const ShiftedFactor> factor;  // at the band limit
};

// Exactly the modes below band_limit_hz: the factorisation of K - sigma M at the band limit gives
// their number (inertia count) and also serves to compute them. K, M: n × n, M positive definite, K
// positive semidefinite.
// Throws ModelError if the solver does not converge, if a residual exceeds 1e-6 or what rounding
// leaves (some units of |K| |x|, 1e-2 at most), if the result disagrees with the count, or for more
// than a thousand modes.
Modes solve_modes(const StiffnessAndMass& matrices, double band_limit_hz,
                  const ProgressHook& progress = {});
}  // namespace tapstudy::core
