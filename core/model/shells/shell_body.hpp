#pragma once
#include <vector>

#include "core/model/discrete_body.hpp"
namespace tapstudy::core {
// A plate as shell elements of this order, plate.mesh.shell_width_m wide. The nodes that a fixation
// holds, on whichever face, hold the place of the lattice below or above them: one layer leaves
// it to turn about that layer, two hold it. Springs and joints act likewise.
// Throws ModelError as discretised.
DiscreteBody shell_body(const Plate& plate, const Material& material, int order,
                        const std::vector<Fixation>& regions, const ProgressHook& progress);
}  // namespace tapstudy::core
