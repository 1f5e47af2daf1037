#pragma once
#include <Eigen/SparseCore>
#include <vector>

#include "core/model/material.hpp"
#include "core/model/tet_mesh.hpp"
namespace tapstudy::core {
using SparseMatrix = Eigen::SparseMatrix<double>;

// Where each degree of freedom of the mesh (x0 y0 z0 x1 …) stands among the free ones; -1 if held.
struct FreeDofs {
  std::vector<int> position;
  int count{0};
};
FreeDofs free_dofs(const std::vector<bool>& held);

struct StiffnessAndMass {
  SparseMatrix K;  // N/m
  SparseMatrix M;  // kg
};

// Linear elasticity on linear tetrahedra (T4): constant strain, K = sum V B' D B, and the
// consistent mass of the element, rho V / 20 (1 + delta_ij) along each axis (Zienkiewicz & Taylor,
// The Finite Element Method, volume 1). Both symmetric, stored whole, rows and columns of held
// degrees of freedom left out. Throws ModelError if a tetrahedron has no volume.
StiffnessAndMass assemble(const TetMesh& mesh, const Material& material, const FreeDofs& dofs);
}  // namespace tapstudy::core
