#pragma once
#include <optional>
#include <vector>

#include "core/model/box.hpp"
#include "core/model/tet_mesh.hpp"
namespace tapstudy::core {
struct MeshSize {
  // TetGen's bound on circumradius over shortest edge; 1.414 gives the paper's coarse plate.
  double radius_edge_ratio{1.414};
  std::optional<double> max_tet_volume_m3{};  // unset: as large as the shape allows
};

// A quality mesh of the box (TetGen, Si 2015) that has the given points of the box among its nodes.
// Throws ModelError if the sizes ask for more than 200 000 tetrahedra or TetGen gives up.
TetMesh mesh_box(const Box& box, const MeshSize& size, const std::vector<Vec3>& points_m = {});
}  // namespace tapstudy::core
