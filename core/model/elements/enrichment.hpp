#pragma once
#include <vector>

#include "core/model/elements/assembly.hpp"
namespace tapstudy::core {
// A body's finite element space enlarged by one polynomial order on the same tetrahedra, for error
// estimates: linear to quadratic, quadratic to hierarchic cubic. It contains the given space, so
// that its eigenvalues are lower, and nothing that was held is free.
struct EnrichedBody {
  StiffnessAndMass matrices;
  // The place of each free degree of freedom of the given space among those of the enlarged one.
  std::vector<int> place;
  // The given space's displacements in the enlarged space, one column a degree of freedom.
  SparseMatrix prolongation;
};
EnrichedBody enriched(const TetMesh& mesh, const Material& material, const FreeDofs& dofs,
                      const std::vector<SpringSupport>& springs);

// The free degrees of freedom of `enriched`, without building it.
int enriched_dofs(const TetMesh& mesh, const FreeDofs& dofs);
}  // namespace tapstudy::core
