#pragma once
#include <Eigen/Core>

#include "core/model/material.hpp"
namespace tapstudy::core {
// All that a tick needs of a plate: modes inside the band and the part of their shapes that can be
// touched. Never changes once built; shared by trials and threads.
struct ModalModel {
  using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;
  using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Eigen::ArrayXd frequency_hz;   // ascending
  Eigen::ArrayXd damping_ratio;  // paper eq. 12
  RayleighDamping damping;

  Points touch_nodes_m;     // plate frame
  Triangles touch_surface;  // into touch_nodes_m, normals outward
  // Row 3 i + a: displacement of touch node i along axis a, per unit of each modal coordinate
  // [kg^-1/2]; the touchable rows of the paper's P (eq. 9).
  Rows shape;
};

struct ModelCost {
  double mesh_s{};
  double assemble_s{};
  double solve_s{};
};

// What the building of a model found out, for people and for proof.
struct ModelReport {
  int nodes{};
  int tets{};
  int dofs{};  // free ones
  int rigid_body_modes{};
  int counted_in_band{};
  double worst_residual{};
  ModelCost cost;
};
}  // namespace tapstudy::core
