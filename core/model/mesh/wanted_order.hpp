#pragma once
#include "core/model/mesh/tetgen_mesher.hpp"
namespace tapstudy::core {
enum class WantedOrder { linear, quadratic_if_small };

// As mesh_shape; the mesh of a surface has a larger radius-edge ratio also where quadratic elements
// would otherwise have more than max_chosen_dofs unknowns, and sizes are not stated.
TetMesh mesh_shape(const Shape& shape, const MeshSize& size, const std::vector<Vec3>& points_m,
                   WantedOrder wanted);

// Whether the largest ratio that mesh_shape tries gives a mesh without many added points.
bool can_be_meshed(const Solid& body);
}  // namespace tapstudy::core
