#pragma once
#include <optional>
namespace tapstudy::core {
struct MeshSize {
  // TetGen's bound on circumradius over shortest edge; 1.414 gives the paper's coarse plate.
  double radius_edge_ratio{1.414};
  std::optional<double> max_tet_volume_m3{};  // unset: as large as the shape allows
  // The body is meshed this many times thicker (along z) and pressed flat again: tetrahedra that
  // are wider than thick, for sheets that would otherwise take millions. The flatter, the stiffer
  // they are for their number: an accuracy shows it.
  double flattening{1.0};
};
inline constexpr double max_tets = 3e5;
inline constexpr double max_flattening = 20.0;
}  // namespace tapstudy::core
