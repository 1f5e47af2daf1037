#pragma once
#include <Eigen/Core>

#include "core/model/elements/elastic_stiffness.hpp"
namespace tapstudy::core {
// The element matrices of a straight-sided tetrahedron with 4 nodes (T4, linear) or 10 (T10,
// quadratic), numbered as in TetMesh; or with 20 unknowns (cubic): T10's and the hierarchic
// functions l_i l_j (l_i - l_j) of its edges, from the corner that tet_edges names first, and
// l_i l_j l_k of its faces. All are integrated exactly (Zienkiewicz & Taylor, The Finite Element
// Method, volume 1).
template <int Nodes>
struct TetElement {
  Eigen::Matrix<double, 3 * Nodes, 3 * Nodes> stiffness;  // N/m; x0 y0 z0 x1 …
  Eigen::Matrix<double, Nodes, Nodes> mass;               // kg, the same along x, y and z
};
using TetCorners = Eigen::Matrix<double, 4, 3>;  // one corner per row [m], positive volume

template <int Nodes>
TetElement<Nodes> tet_element(const TetCorners& corners_m, const ElasticStiffness& elasticity,
                              double density_kg_per_m3);
}  // namespace tapstudy::core
