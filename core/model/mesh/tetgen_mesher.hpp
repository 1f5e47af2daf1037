#pragma once
#include <vector>

#include "core/model/mesh/mesh_size.hpp"
#include "core/model/mesh/tet_mesh.hpp"
#include "core/model/shape/shape.hpp"
namespace tapstudy::core {
// A quality mesh of the body (TetGen, Si 2015) of order 1 that has the given points of its surface
// among its nodes (of a box only).
// Throws ModelError if the sizes ask for more than max_tets tetrahedra or TetGen gives up.
TetMesh mesh_shape(const Shape& shape, const MeshSize& size,
                   const std::vector<Vec3>& points_m = {});
}  // namespace tapstudy::core
