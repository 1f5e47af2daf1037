#include "core/model/elements/spring_support.hpp"

#include "core/model/elements/assembly.hpp"
namespace tapstudy::core {
namespace {
// K of two nodes, or of one.
class Coupling {
 public:
  Coupling(const FreeDofs& dofs, const Eigen::Vector3d& stiffness_n_per_m,
           Eigen::SparseMatrix<double>& K)
      : dofs_{dofs}, stiffness_n_per_m_{stiffness_n_per_m}, k_{K} {}

  void add(Eigen::Index row, Eigen::Index column, double share) const {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const int a = dofs_.position[static_cast<std::size_t>(3 * row + axis)];
      const int b = dofs_.position[static_cast<std::size_t>(3 * column + axis)];
      if (b >= 0 && a >= b && stiffness_n_per_m_[axis] > 0.0) {
        k_.coeffRef(a, b) += share * stiffness_n_per_m_[axis];
      }
    }
  }

 private:
  const FreeDofs& dofs_;
  const Eigen::Vector3d& stiffness_n_per_m_;
  Eigen::SparseMatrix<double>& k_;
};

void add_foundation(const TetMesh& mesh, const std::vector<TrianglePart>& parts,
                    const Coupling& coupling) {
  double whole_m2 = 0.0;
  for (const TrianglePart& part : parts) {
    whole_m2 += part.area_m2;
  }
  for (const TrianglePart& part : parts) {
    for (Eigen::Index i = 0; i < part.products_m2.cols(); ++i) {
      for (Eigen::Index j = 0; j < part.products_m2.cols(); ++j) {
        coupling.add(mesh.surface(part.triangle, i), mesh.surface(part.triangle, j),
                     part.products_m2(i, j) / whole_m2);
      }
    }
  }
}
}  // namespace

void add_springs(const TetMesh& mesh, const std::vector<SpringSupport>& supports,
                 const FreeDofs& dofs, Eigen::SparseMatrix<double>& K) {
  for (const SpringSupport& support : supports) {
    const Coupling coupling{dofs, support.stiffness_n_per_m, K};
    const auto parts = parts_within(mesh, support.region);
    if (!parts.empty()) {
      add_foundation(mesh, parts, coupling);
      continue;
    }
    const std::vector<Eigen::Index>& nodes = support.region.nodes;
    for (const Eigen::Index node : nodes) {
      coupling.add(node, node, 1.0 / static_cast<double>(nodes.size()));
    }
  }
}
}  // namespace tapstudy::core
