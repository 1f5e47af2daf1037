#pragma once
namespace tapstudy::core {
// As Meshing::order: straight-sided tetrahedra of order 3, for sheets and thin walls, where flat
// elements of lower order bend too stiffly. They have T10's nodes; what else they have is no
// displacement of a node (tet_mesh.hpp).
inline constexpr int cubic_order = 3;
// How much wider than thick they may be.
inline constexpr double max_cubic_flattening = 100.0;
}  // namespace tapstudy::core
