#pragma once
#include <Eigen/Core>
#include <vector>

#include "core/model/elements/assembly.hpp"
#include "core/model/mesh/tet_mesh.hpp"
#include "core/model/modal_model.hpp"
#include "core/model/modes/modal_solver.hpp"
#include "core/model/plate.hpp"
#include "core/model/progress.hpp"
namespace tapstudy::core {
// A body as finite elements: mesh, constraints and matrices (paper section 4.2.1). Of shells the
// mesh is that on which others see their shapes.
struct DiscreteBody {
  TetMesh mesh;
  FreeDofs dofs;  // of the mesh's nodes
  StiffnessAndMass matrices;
  // Of the nodes (x0 y0 z0 x1 …), by the unknowns of the matrices: the free degrees of freedom, or
  // those of shells.
  Eigen::SparseMatrix<double, Eigen::RowMajor> displacement;
  int order{};     // of the elements
  int elements{};  // their number
  ModelCost cost;  // of meshing and assembling
};

// regions: whose nodes the mesh must have beside those of the fixations.
// Throws ModelError if it cannot be meshed, or a fixation holds nothing or everything.
DiscreteBody discretised(const Plate& plate, const Material& material, const MeshSize& size,
                         const std::vector<Fixation>& regions, const ProgressHook& progress);

// The cost and outcome of solving these bodies, at least one, as one system.
ModelReport report_on(const std::vector<DiscreteBody>& bodies, const Modes& modes);
}  // namespace tapstudy::core
