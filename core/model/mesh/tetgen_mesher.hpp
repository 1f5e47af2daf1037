#pragma once
#include <optional>
#include <vector>

#include "core/model/mesh/tet_mesh.hpp"
#include "core/model/shape/shape.hpp"
namespace tapstudy::core {
struct MeshSize {
  // TetGen's bound on circumradius over shortest edge; 1.414 gives the paper's coarse plate. The
  // mesh of a surface has a larger one where this one would take too many elements.
  double radius_edge_ratio{1.414};
  std::optional<double> max_tet_volume_m3{};  // unset: no bound
  // The body is meshed scaled by this factor along z and then scaled back: flattened tetrahedra,
  // for thin sheets that would otherwise take millions. Flatter elements are stiffer for the same
  // element count; setting an accuracy reveals it.
  double flattening{1.0};
};
inline constexpr double max_tets = 3e5;
inline constexpr double max_flattening = 20.0;

// An order 1 quality mesh of the body (TetGen, Si 2015) with the given surface points among its
// nodes (box only).
// Throws ModelError if the sizes require more than max_tets tetrahedra or TetGen fails, with the
// command that simplifies a surface.
TetMesh mesh_shape(const Shape& shape, const MeshSize& size,
                   const std::vector<Vec3>& points_m = {});
}  // namespace tapstudy::core
