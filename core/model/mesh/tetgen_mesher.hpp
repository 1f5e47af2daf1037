#pragma once
#include <vector>

#include "core/model/mesh/mesh_size.hpp"
#include "core/model/mesh/tet_mesh.hpp"
#include "core/model/shape/shape.hpp"
namespace tapstudy::core {
// An order 1 quality mesh of the body (TetGen, Si 2015) with the given surface points among its
// nodes (box only).
// Throws ModelError if the sizes require more than max_tets tetrahedra or TetGen fails.
TetMesh mesh_shape(const Shape& shape, const MeshSize& size,
                   const std::vector<Vec3>& points_m = {});
}  // namespace tapstudy::core
