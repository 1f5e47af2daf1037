#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/model/fixation.hpp"
#include "core/model/mesh/tetgen_mesher.hpp"
#include "core/model/modal_model.hpp"
#include "core/model/progress_hook.hpp"
namespace tapstudy::core {
struct Meshing {
  MeshSize size;
  int order{1};  // of the elements: 1 (T4) or 2 (T10)
  // Refine until no frequency in the band moves by more than this fraction; unset: the size given.
  std::optional<double> accuracy{};
};

// A body before its stiffness and density are known. Stiffness, mass and spectrum scale exactly
// with Young's modulus E and density rho, so one solution for E = 1 Pa, rho = 1 kg/m³ serves every
// material of one Poisson's ratio: omega = kappa sqrt(E / rho), with kappa in rad/m, and mode
// shapes divide by sqrt(rho).
struct BodySpec {
  Shape shape;
  Meshing mesh;
  std::vector<Fixation> fixations;
  double poissons_ratio{};
  double band_limit_rad_per_m{};  // of kappa; > 0
};

// Equal text for bodies that have one and the same solution.
std::string content_key(const BodySpec& body);

// What can be felt of a body: see ModalModel, for the unit material.
struct BodyModes {
  Eigen::ArrayXd kappa_rad_per_m;  // ascending
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
