#include "core/model/assembly.hpp"

#include <fmt/format.h>

#include <array>

#include "core/error.hpp"
#include "core/model/linear_tet.hpp"
namespace tapstudy::core {
namespace {
using Triplets = std::vector<Eigen::Triplet<double>>;

std::array<int, 12> element_positions(const TetMesh& mesh, Eigen::Index tet, const FreeDofs& dofs) {
  std::array<int, 12> positions{};
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto node = static_cast<std::size_t>(mesh.tets(tet, static_cast<Eigen::Index>(i / 3)));
    positions.at(i) = dofs.position.at(3 * node + i % 3);
  }
  return positions;
}

void scatter(const Eigen::Matrix<double, 12, 12>& element, const std::array<int, 12>& positions,
             Triplets& into) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (std::size_t j = 0; j < positions.size(); ++j) {
      const double value = element(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      if (positions.at(i) >= 0 && positions.at(j) >= 0 && value != 0.0) {
        into.emplace_back(positions.at(i), positions.at(j), value);
      }
    }
  }
}

TetCorners corners_of(const TetMesh& mesh, Eigen::Index tet) {
  TetCorners corners;
  for (Eigen::Index i = 0; i < 4; ++i) {
    corners.row(i) = mesh.nodes_m.row(mesh.tets(tet, i));
  }
  return corners;
}
}  // namespace

FreeDofs free_dofs(const std::vector<bool>& held) {
  FreeDofs dofs;
  dofs.position.reserve(held.size());
  for (const bool is_held : held) {
    dofs.position.push_back(is_held ? -1 : dofs.count++);
  }
  return dofs;
}

StiffnessAndMass assemble(const TetMesh& mesh, const Material& material, const FreeDofs& dofs) {
  check_material(material);
  const Eigen::Matrix<double, 6, 6> elasticity = elasticity_matrix(material);
  Triplets stiffness;
  Triplets mass;
  stiffness.reserve(static_cast<std::size_t>(144 * mesh.tets.rows()));
  mass.reserve(static_cast<std::size_t>(48 * mesh.tets.rows()));
  for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
    if (!(tet_volume_m3(mesh, tet) > 0.0)) {
      throw ModelError{fmt::format("mesh: tetrahedron {} has no volume", tet)};
    }
    const LinearTet element =
        linear_tet(corners_of(mesh, tet), elasticity, material.density_kg_per_m3);
    const std::array<int, 12> positions = element_positions(mesh, tet, dofs);
    scatter(element.stiffness, positions, stiffness);
    scatter(element.mass, positions, mass);
  }
  StiffnessAndMass matrices{SparseMatrix(dofs.count, dofs.count),
                            SparseMatrix(dofs.count, dofs.count)};
  matrices.K.setFromTriplets(stiffness.begin(), stiffness.end());
  matrices.M.setFromTriplets(mass.begin(), mass.end());
  return matrices;
}  // NOLINT(clang-analyzer-unix.Malloc): Eigen's own arrays, freed by their destructors
}  // namespace tapstudy::core
