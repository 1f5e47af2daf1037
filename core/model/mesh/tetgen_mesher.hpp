#pragma once
#include <optional>
#include <vector>

#include "core/model/mesh/tet_mesh.hpp"
#include "core/model/shape/shape.hpp"
namespace tapstudy::core {
struct MeshSize {
  // TetGen's bound on circumradius over shortest edge; 1.414 gives the paper's coarse plate.
  double radius_edge_ratio{1.414};
  std::optional<double> max_tet_volume_m3{};  // unset: as large as the shape allows
  // The body is meshed this many times thicker (along z) and pressed flat again: tetrahedra that
  // are wider than thick, for sheets that would else take millions. The flatter, the stiffer they
  // are for their number: an accuracy shows it.
  double flattening{1.0};
};
inline constexpr double most_tets = 3e5;
inline constexpr double most_flattening = 20.0;

// A quality mesh of the body (TetGen, Si 2015) of order 1 that has the given points of its surface
// among its nodes (of a box only).
// Throws ModelError if the sizes ask for more than most_tets tetrahedra or TetGen gives up.
TetMesh mesh_shape(const Shape& shape, const MeshSize& size,
                   const std::vector<Vec3>& points_m = {});
}  // namespace tapstudy::core
