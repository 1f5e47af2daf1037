#pragma once
#include <Eigen/Core>

#include "core/model/elements/assembly.hpp"
#include "core/model/elements/enrichment.hpp"
#include "core/model/modes/modal_solver.hpp"
#include "core/model/progress.hpp"
namespace tapstudy::core {
// The natural angular frequencies [rad/s] of a body's modes and of a few beyond the band in a
// larger finite element space, ascending, approximately. By the min-max principle none is above
// that of the given space or below the exact one: the drop is a lower bound of the error.
//
// Locally optimal block conjugate gradients (LOBPCG, Knyazev 2001), from the given modes on.
// Preconditioner in two levels, as the hierarchy has them (Bank 1996): a symmetric Gauss-Seidel
// step on what the larger space adds, then the given space's factor at the band limit. It ends when
// a step, and what those to come would add by how the last two shrank, is less than a fiftieth of
// every drop, or after 100. The same start always, so the same result.
Eigen::ArrayXd frequencies_in_larger_space(const StiffnessAndMass& given, const Modes& modes,
                                           const EnrichedBody& larger,
                                           const ProgressHook& progress);
}  // namespace tapstudy::core
