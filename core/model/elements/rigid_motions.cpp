#include "core/model/elements/rigid_motions.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/algebra/lapack.hpp"
#include "core/model/elements/assembly.hpp"
namespace tapstudy::core {
namespace {
// Threshold for the squared participation of constrained nodes in a rigid-body motion, relative to
// that of all motions: far above rounding, far below a screw head on a plate.
constexpr double nothing_holds = 1e-14;

// One flag a degree of freedom: constrained, or on a spring.
std::vector<bool> resisted_dofs(const FreeDofs& dofs, const std::vector<SpringSupport>& springs) {
  std::vector<bool> resisted(dofs.position.size(), false);
  for (std::size_t i = 0; i < resisted.size(); ++i) {
    resisted[i] = dofs.position[i] < 0;
  }
  for (const SpringSupport& support : springs) {
    for (const Eigen::Index node : support.region.nodes) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        if (support.stiffness_n_per_m[axis] > 0.0) {
          resisted[static_cast<std::size_t>(3 * node + axis)] = true;
        }
      }
    }
  }
  return resisted;
}
}  // namespace

RigidMotions::RigidMotions(const TetMesh& mesh)
    : mesh_{mesh},
      middle_m_{mesh.nodes_m.colwise().mean().transpose()},
      size_m_{(mesh.nodes_m.rowwise() - middle_m_.transpose()).rowwise().norm().maxCoeff()} {}

Eigen::Matrix<double, 6, 1> RigidMotions::displacement(const Eigen::Vector3d& place_m,
                                                       Eigen::Index axis) const {
  const Eigen::Vector3d arm = (place_m - middle_m_) / size_m_;
  Eigen::Matrix<double, 6, 1> motion;
  motion << Eigen::Vector3d::Unit(axis), arm.cross(Eigen::Vector3d::Unit(axis));
  return motion;
}

Eigen::Matrix<double, 6, 6> RigidMotions::resisted(
    const FreeDofs& dofs, const std::vector<SpringSupport>& springs) const {
  const std::vector<bool> is_resisted = resisted_dofs(dofs, springs);
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  for (Eigen::Index node = 0; node < mesh_.nodes_m.rows(); ++node) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (is_resisted[static_cast<std::size_t>(3 * node + axis)]) {
        const auto motion = displacement(mesh_.nodes_m.row(node).transpose(), axis);
        sum += motion * motion.transpose();
      }
    }
  }
  return sum;
}

int unresisted(const Eigen::MatrixXd& resisted_motions) {
  const double threshold = nothing_holds * std::max(1.0, resisted_motions.trace());
  return static_cast<int>(
      (symmetric_eigenpairs(resisted_motions).values.array() < threshold).count());
}
}  // namespace tapstudy::core
