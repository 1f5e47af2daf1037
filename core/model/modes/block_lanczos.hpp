#pragma once
#include <Eigen/Core>
#include <functional>

#include "core/model/elements/assembly.hpp"
#include "core/model/modes/shifted_factor.hpp"
#include "core/model/progress_hook.hpp"
namespace tapstudy::core {
// Columns, not normalised, in no order.
struct RitzVectors {
  Eigen::MatrixXd wanted;
  // Near eigenvectors from the shift up to twice the shift; made when asked for, which few do.
  std::function<Eigen::MatrixXd()> guards;
};

// The `count` eigenvectors of K x = lambda M x whose eigenvalues lie below the factor's shift, and
// what was found of others on the way.
//
// Lanczos in blocks (Golub & Underwood 1977) on (K - sigma M)^-1 M, orthogonal in the metric of M.
// Its eigenvalues are nu = 1 / (lambda - sigma): those wanted are the negative ones, and the count
// says how many there are. Blocks find multiple eigenvalues and cost little more to solve for than
// single vectors. The same start always, so the same vectors.
// Throws ModelError if not all have converged when the basis is full.
RitzVectors eigenvectors_below_shift(const StiffnessAndMass& matrices, const ShiftedFactor& factor,
                                     int count, const ProgressHook& progress);
}  // namespace tapstudy::core
