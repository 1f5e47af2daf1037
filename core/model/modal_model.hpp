#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/model/elements/material.hpp"
#include "core/model/mesh/tet_mesh.hpp"
namespace tapstudy::core {
// All that a tick needs of a plate: modes inside the band and the part of their shapes that can be
// touched. Put into modal coordinates, x = P q (paper eq. 9, 10), the plate's equation of motion is
// one oscillator a mode, q'' + 2 zeta w q' + w² q = p' f with p the mode's shape (eq. 11).
// Never changes once built; shared by trials and threads.
struct ModalModel {
  using Triangles = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Eigen::ArrayXd frequency_hz;             // ascending
  Eigen::ArrayXd damping_ratio;            // paper eq. 12, or as measured
  std::optional<RayleighDamping> damping;  // unset for individual modal ratios

  Points touch_nodes_m;     // plate frame
  Triangles touch_surface;  // into touch_nodes_m: 3 corners, normals outward; for order 2 also the
                            // mid-side nodes of the edges 01 12 20
  // Row 3 i + a: displacement of touch node i along axis a, per unit of each modal coordinate
  // [kg^-1/2]; the touchable rows of the paper's P (eq. 9).
  Rows shape;
};

struct ModelCost {
  double mesh_s{};
  double assemble_s{};
  double factor_s{};
  double iterate_s{};
  double total_s() const { return mesh_s + assemble_s + factor_s + iterate_s; }
};

// One step of refining a mesh until the natural frequencies converge.
struct RefinementRound {
  int tets{};
  int modes{};
  double moved{};  // largest relative change of a frequency since the previous round
};

// As what a body was meshed.
struct MeshedBody {
  int order{};  // of its elements; of shells shell_order
  RadiusEdgeRatio radius_edge_ratio{};
};

// Statistics of building a model, for display and verification.
struct ModelReport {
  std::vector<MeshedBody> bodies;  // the one that is tapped, then those it touches; of a beam none
  int nodes{};
  int tets{};  // or shell elements
  int dofs{};  // free degrees of freedom
  int rigid_body_modes{};
  int counted_in_band{};
  double worst_residual{};
  ModelCost cost;                           // of all rounds
  std::vector<RefinementRound> refinement;  // empty unless an accuracy was asked for
  int order() const { return bodies.empty() ? 0 : bodies.front().order; }
};
}  // namespace tapstudy::core
