#include "core/model/elements/spring_support.hpp"

#include "core/model/elements/assembly.hpp"
#include "core/model/elements/surface_region.hpp"
namespace tapstudy::core {
namespace {
// The integrals of products of two shape functions over a triangle, per unit of its area
// (Zienkiewicz & Taylor): linear, and quadratic with mid-side nodes of the edges 01 12 20.
Eigen::MatrixXd products_per_area(Eigen::Index nodes) {
  if (nodes == 3) {
    return (Eigen::Matrix3d::Identity() + Eigen::Matrix3d::Ones()) / 12.0;
  }
  Eigen::MatrixXd products(6, 6);
  products << 6, -1, -1, 0, -4, 0,  //
      -1, 6, -1, 0, 0, -4,          //
      -1, -1, 6, -4, 0, 0,          //
      0, 0, -4, 32, 16, 16,         //
      -4, 0, 0, 16, 32, 16,         //
      0, -4, 0, 16, 16, 32;
  return products / 180.0;
}

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

void add_foundation(const TetMesh& mesh, const std::vector<Eigen::Index>& triangles,
                    const Coupling& coupling) {
  double whole_m2 = 0.0;
  for (const Eigen::Index triangle : triangles) {
    whole_m2 += triangle_area_m2(mesh, triangle);
  }
  const Eigen::Index nodes = mesh.surface.cols();
  const Eigen::MatrixXd products = products_per_area(nodes);
  for (const Eigen::Index triangle : triangles) {
    const double share = triangle_area_m2(mesh, triangle) / whole_m2;
    for (Eigen::Index i = 0; i < nodes; ++i) {
      for (Eigen::Index j = 0; j < nodes; ++j) {
        coupling.add(mesh.surface(triangle, i), mesh.surface(triangle, j), share * products(i, j));
      }
    }
  }
}
}  // namespace

void add_springs(const TetMesh& mesh, const std::vector<SpringSupport>& supports,
                 const FreeDofs& dofs, Eigen::SparseMatrix<double>& K) {
  for (const SpringSupport& support : supports) {
    const Coupling coupling{dofs, support.stiffness_n_per_m, K};
    const auto triangles = triangles_within(mesh, support.nodes);
    if (!triangles.empty()) {
      add_foundation(mesh, triangles, coupling);
      continue;
    }
    for (const Eigen::Index node : support.nodes) {
      coupling.add(node, node, 1.0 / static_cast<double>(support.nodes.size()));
    }
  }
}
}  // namespace tapstudy::core
