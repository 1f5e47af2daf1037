#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "core/model/elements/surface_region.hpp"
namespace tapstudy::core {
struct FreeDofs;

// Springs between a region of the body's surface and the ground, along the axes of the plate frame.
struct SpringSupport {
  SurfaceRegion region;
  Eigen::Vector3d stiffness_n_per_m{};  // of the whole region; >= 0
};

// Adds the springs to K (lower triangle, of the free degrees of freedom). They are spread evenly
// over the region, as an elastic foundation (Winkler 1867) of k / A per area, integrated with the
// elements' shape functions; over the nodes themselves where it holds no part of a triangle. Their
// sum is k on any mesh.
void add_springs(const TetMesh& mesh, const std::vector<SpringSupport>& supports,
                 const FreeDofs& dofs, Eigen::SparseMatrix<double>& K);
}  // namespace tapstudy::core
