#pragma once
#include "core/model/assembly.hpp"
namespace tapstudy::core {
// How many eigenvalues of K x = lambda M x lie below sigma [rad²/s²]: the number of negative pivots
// of L D L' = K - sigma M (Sylvester's law of inertia). Throws ModelError if it has no L D L'.
int eigenvalues_below(const StiffnessAndMass& matrices, double sigma);
}  // namespace tapstudy::core
