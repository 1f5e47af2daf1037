#pragma once
#include <Eigen/Core>
#include <vector>

#include "core/model/elements/spring_support.hpp"
#include "core/model/mesh/tet_mesh.hpp"
namespace tapstudy::core {
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

// How many motions nothing resists: the dimension of the null space of such a sum.
int unresisted(const Eigen::MatrixXd& resisted_motions);
}  // namespace tapstudy::core
