#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "core/model/elements/material.hpp"
#include "core/model/elements/spring_support.hpp"
#include "core/model/mesh/tet_mesh.hpp"
namespace tapstudy::core {
using SparseMatrix = Eigen::SparseMatrix<double>;

// Index of each mesh degree of freedom (x0 y0 z0 x1 …) among the free ones; -1 if constrained.
struct FreeDofs {
  std::vector<int> position;
  int count{0};
};
FreeDofs free_dofs(const std::vector<bool>& held);

// The K and M of M x'' + C x' + K x = f (paper eq. 2). Constraints are applied by elimination: a
// constrained degree of freedom has no row. Symmetric, of the free degrees of freedom; only the
// lower triangles are stored.
struct StiffnessAndMass {
  SparseMatrix K;  // N/m
  SparseMatrix M;  // kg
  // Start of each node's block of unknowns, and the end: blocks are kept together in ordering.
  std::vector<int> first_of_node{};
  // Rigid-body motions that neither constraints nor springs resist: 0 to 6.
  int rigid_body_modes{0};
  // The resistance to these motions, six rows and columns for each body (RigidMotions::resisted).
  Eigen::MatrixXd resisted_motions{};
  auto stiffness() const { return K.selfadjointView<Eigen::Lower>(); }
  auto mass() const { return M.selfadjointView<Eigen::Lower>(); }
};

// Linear elasticity with consistent mass, for meshes of order 1 to 3, and the springs that hold
// the body to the ground. Throws ModelError if a tetrahedron has no volume.
StiffnessAndMass assemble(const TetMesh& mesh, const Material& material, const FreeDofs& dofs,
                          const std::vector<SpringSupport>& springs = {});

struct FreeDofs;

// The six motions of a body that do not deform it: translations along x, y and z, then rotations
// about them; lengths relative to the body's size.
class RigidMotions {
 public:
  explicit RigidMotions(const TetMesh& mesh);
  // The displacement along an axis of a place of the body, for a unit of each motion.
  Eigen::Matrix<double, 6, 1> displacement(const Eigen::Vector3d& place_m, Eigen::Index axis) const;
  // The sum of their outer products over all constrained and sprung degrees of freedom.
  Eigen::Matrix<double, 6, 6> resisted(const FreeDofs& dofs,
                                       const std::vector<SpringSupport>& springs) const;

 private:
  const TetMesh& mesh_;
  Eigen::Vector3d middle_m_;
  double size_m_;
};

// The number of motions that nothing resists: the dimension of the null space of such a sum.
int unresisted(const Eigen::MatrixXd& resisted_motions);
}  // namespace tapstudy::core
