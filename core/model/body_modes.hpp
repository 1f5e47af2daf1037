#pragma once
#include <string>
#include <vector>

#include "core/model/mesh/tet_mesh.hpp"
#include "core/model/modal_model.hpp"
#include "core/model/plate.hpp"
#include "core/model/progress_hook.hpp"
namespace tapstudy::core {
// Equal text for bodies that have one and the same solution.
std::string content_key(const BodySpec& body);

// What can be felt of a body: see ModalModel, for the unit material.
struct BodyModes {
  Eigen::ArrayXd kappa_rad_per_m;  // ascending
  double band_limit_rad_per_m{};   // every mode below is there
  ModalModel::Points touch_nodes_m;
  ModalModel::Triangles touch_surface;
  ModalModel::Rows shape;
  ModelReport report;
};

// The body whole, for views and other programs.
struct SolvedBody {
  TetMesh mesh;
  Eigen::MatrixXd displacement;  // row 3 i + a: of node i along axis a; one column a mode
  BodyModes modes;
};

// Mesh, matrices, modes (paper sections 4.2.1 and 4.2.2).
// Throws ModelError for what cannot be built, or if the accuracy is out of reach.
SolvedBody solve_body(const BodySpec& body, const ProgressHook& progress = {});
}  // namespace tapstudy::core
