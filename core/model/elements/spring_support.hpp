#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>
#include <vector>

#include "core/model/mesh/tet_mesh.hpp"
namespace tapstudy::core {
// A convex region of a body's surface.
struct SurfaceRegion {
  std::vector<Eigen::Index> nodes;  // in it; at least one
  std::function<bool(const Eigen::Vector3d& at_m)> holds;
};

// The part of a surface triangle that lies in a region.
struct TrianglePart {
  Eigen::Index triangle{};
  double area_m2{};
  Eigen::MatrixXd products_m2;  // integrals over it of N N^T, N the shape functions of its nodes
};
// Exact for triangles that lie in the region whole; of others what a bisection of their edges, to a
// 64th, finds inside. Empty where the region holds no part of a triangle, such as a point.
std::vector<TrianglePart> parts_within(const TetMesh& mesh, const SurfaceRegion& region);

struct NodeWeight {
  Eigen::Index node{};
  double weight{};
};
// The weights, of sum 1, whose sum over nodal displacements is the mean displacement of the surface
// triangles all of whose nodes are among these, by the elements' shape functions; of the nodes
// themselves where there is no such triangle. A disc's triangles are alike on every mesh as far as
// its meshed centre and rim go, so that the ends of a spring between two discs lie on one another.
std::vector<NodeWeight> mean_weights(const TetMesh& mesh, const std::vector<Eigen::Index>& nodes);

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
