#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>
#include <vector>

#include "core/model/mesh/tet_mesh.hpp"
namespace tapstudy::core {
// A convex region of a body, and what it takes up of a mesh: these nodes, be it held rigidly, held
// by springs, or joined to another body.
struct SurfaceRegion {
  std::vector<Eigen::Index> nodes;  // in it; at least one
  std::function<bool(const Eigen::Vector3d& at_m)> holds;
};

// The surface triangles of which these are the corners: the region's own, as it is convex.
std::vector<Eigen::Index> triangles_between(const TetMesh& mesh,
                                            const std::vector<Eigen::Index>& nodes);

// The area of what the region takes up of the surface: of a triangle that lies in it in part, of
// that part. 0 for a point or a line.
double area_within_m2(const TetMesh& mesh, const SurfaceRegion& region);

struct NodeWeight {
  Eigen::Index node{};
  double weight{};
};
// The weights, of sum 1, whose sum over nodal displacements is the mean displacement of the surface
// triangles between these nodes, by the elements' shape functions; of the nodes themselves where
// there is no such triangle. A disc's triangles are alike on every mesh as far as its meshed centre
// and rim go, so that the ends of a spring between two discs lie on one another.
std::vector<NodeWeight> mean_weights(const TetMesh& mesh, const std::vector<Eigen::Index>& nodes);

struct FreeDofs;

// Springs between a region of the body and the ground, along the axes of the plate frame.
struct SpringSupport {
  SurfaceRegion region;
  Eigen::Vector3d stiffness_n_per_m{Eigen::Vector3d::Zero()};  // of the whole region; >= 0
};

// Adds the springs to K (lower triangle, of the free degrees of freedom). They hold the region's
// nodes and no others, so that ever stiffer ones become the rigid fixation of the same region: an
// elastic foundation (Winkler 1867) under the triangles between its nodes, and single springs at
// nodes that no such triangle has. To motions that do not deform the region they are the foundation
// of its whole surface, of k / A per area: their sum is k, and they resist turning alike, on any
// mesh, of few or many nodes.
void add_springs(const TetMesh& mesh, const std::vector<SpringSupport>& supports,
                 const FreeDofs& dofs, Eigen::SparseMatrix<double>& K);
}  // namespace tapstudy::core
