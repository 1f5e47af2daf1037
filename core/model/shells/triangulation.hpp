#pragma once
#include <Eigen/Core>
#include <vector>

#include "core/model/fixation.hpp"
#include "core/model/mesh/tet_mesh.hpp"
#include "core/model/shells/lagrange.hpp"
#include "core/model/shells/middle_surface.hpp"
namespace tapstudy::core {
// The middle of a plate as triangles, counter-clockwise from above: the upper face of TetGen's mesh
// of a plate as thick as the triangles are wide, so that they are well shaped, and smaller only
// round the places that these regions need. Throws ModelError as mesh_shape.
TriangleSurface triangulated(const Box& plate, double width_m,
                             const std::vector<Fixation>& regions);

// The places at which polynomials of an order are given, evenly spaced on each triangle and shared
// by neighbours.
struct Lattice {
  int order{};  // even
  TriangleSurface::Points places_m;
  TetMesh::Indices triangles;  // their places, in the order of column_of
  // The unit normal of a triangle at each of its places, one triangle after the other; neighbours
  // that are joined smoothly have one.
  TriangleSurface::Points directors;
  // Of each place, from the middle to the upper face, in half thicknesses: along the normal; at a
  // fold, to where the faces meet.
  TriangleSurface::Points offsets;
  std::vector<bool> is_folded;  // of each place: it has several normals
};
// Throws ModelError where a fold is so sharp that its faces hardly meet.
Lattice lattice_on(const CurvedTriangles& middle, int order);

// The layers in which a plate's mesh has a node at each place of the lattice: bottom, middle, top.
inline constexpr int layers = 3;
constexpr Eigen::Index node_at(Eigen::Index place, int layer) {
  return layers * place + layer;
}
// Above the middle, in half thicknesses.
constexpr double height_of(int layer) {
  return layer - 1.0;
}
// The same body as quadratic tetrahedra on these nodes: what others see of its shapes.
TetMesh layered(const Lattice& lattice, double thickness_m);
}  // namespace tapstudy::core
