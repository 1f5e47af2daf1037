#pragma once
#include <Eigen/Core>
#include <vector>

#include "core/model/fixation.hpp"
#include "core/model/mesh/tet_mesh.hpp"
namespace tapstudy::core {
// A rectangle as triangles, counter-clockwise.
struct Triangulation {
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> corners_m;
  Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor> triangles;
};

// Of a plate seen from above: the upper face of TetGen's mesh of a plate as thick as the triangles
// are wide, so that they are well shaped, and smaller only round the places that these regions
// need. Throws ModelError as mesh_shape.
Triangulation triangulated(const Box& plate, double width_m, const std::vector<Fixation>& regions);

// The places at which polynomials of an order are given, evenly spaced on each triangle and shared
// by neighbours. Place (i, j) of a triangle, i steps towards its second corner and j towards its
// third, is in column `column_of(i, j)` of its row.
struct Lattice {
  int order{};  // even
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> places_m;
  TetMesh::Indices triangles;
  Eigen::Index column_of(Eigen::Index i, Eigen::Index j) const {
    return j * (order + 1) - j * (j - 1) / 2 + i;
  }
  Eigen::Index places_of_triangle() const { return column_of(0, order) + 1; }
};
Lattice lattice_on(const Triangulation& triangulation, int order);

// The layers in which a plate's mesh has a node at each place of the lattice: bottom, middle, top.
inline constexpr int layers = 3;
constexpr Eigen::Index node_at(Eigen::Index place, int layer) {
  return layers * place + layer;
}
// The same plate as quadratic tetrahedra on these nodes: what others see of its shapes.
TetMesh layered(const Lattice& lattice, double low_z_m, double high_z_m);
}  // namespace tapstudy::core
