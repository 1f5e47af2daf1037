#pragma once
#include <string>
#include <vector>

#include "core/model/mesh/tet_mesh.hpp"
#include "core/model/modal_model.hpp"
#include "core/model/plate.hpp"
#include "core/model/progress.hpp"
namespace tapstudy::core {
// Identical text for bodies with identical solutions.
std::string content_key(const BodySpec& body);

// The same body in the space of the next higher element order on the same tetrahedra (quadratic for
// linear elements, cubic for quadratic ones; of shells two orders higher): the drop of its
// frequencies estimates the discretisation error, from below.
struct ErrorEstimate {
  Eigen::ArrayXd kappa_rad_per_m;  // of the modes and a few beyond the band, ascending
  std::string not_estimated;       // why kappa_rad_per_m is empty; empty: estimated
  double seconds{};                // that this took
  // What the drop does not tell: fixations that the mesh holds in part (held_in_part).
  std::string held_in_part{};
};

// As `not_estimated`, where nobody wanted it.
inline constexpr const char* not_asked_for = "not asked for";

// The touchable part of a body's modes: as ModalModel, for the unit material.
struct BodyModes {
  Eigen::ArrayXd kappa_rad_per_m;  // ascending
  double band_limit_rad_per_m{};   // complete below this
  ModalModel::Points touch_nodes_m;
  ModalModel::Triangles touch_surface;
  ModalModel::Rows shape;
  // For a body in contact with others, one column per mode: the shares of the mode's energy that
  // are in it (row 0), in each of the others and, for strain, in each spring. Empty for a body
  // alone.
  Eigen::MatrixXd kinetic_share;
  Eigen::MatrixXd strain_share;
  ModelReport report;
  ErrorEstimate estimate;
};

// The complete solution, for figures and export; of a beam, mesh and displacement are empty.
struct SolvedBody {
  TetMesh mesh;
  Eigen::MatrixXd displacement;  // row 3 i + a: node i, axis a; one column per mode
  BodyModes modes;
};

// Whether the error of discretisation is estimated beside the modes, which takes about as long as
// they do.
enum class ErrorEstimation { none, wanted };

// Mesh, matrices, modes (paper sections 4.2.1 and 4.2.2); or beam_modes.
// Throws ModelError if the model cannot be built or the accuracy cannot be reached.
SolvedBody solve_body(const BodySpec& body, const ProgressHook& progress = {},
                      ErrorEstimation estimation = ErrorEstimation::none);
}  // namespace tapstudy::core
