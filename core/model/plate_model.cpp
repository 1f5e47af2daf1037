#include "core/model/plate_model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <cmath>
#include <map>
#include <numbers>

#include "core/model/damping.hpp"
#include "core/model/modal_solver.hpp"
namespace tapstudy::core {
namespace {
class Stopwatch {
 public:
  double lap_s() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_{std::chrono::steady_clock::now()};
};

// The triangles of the upper face, with their nodes renumbered from 0.
void keep_tapped_face(const TetMesh& mesh, const Box& box, ModalModel& model,
                      std::vector<Eigen::Index>& kept_nodes) {
  const double tolerance_m = box.snap_m();
  const auto is_on_top = [&](int node) {
    return std::abs(mesh.nodes_m(node, 2) - box.high_m().z()) <= tolerance_m;
  };
  std::map<int, int> renumbered;
  std::vector<Eigen::RowVector3i> triangles;
  for (const auto& triangle : mesh.surface.rowwise()) {
    if (!is_on_top(triangle[0]) || !is_on_top(triangle[1]) || !is_on_top(triangle[2])) {
      continue;
    }
    Eigen::RowVector3i own;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const auto [place, is_new] =
          renumbered.emplace(triangle[i], static_cast<int>(renumbered.size()));
      if (is_new) {
        kept_nodes.push_back(triangle[i]);
      }
      own[i] = place->second;
    }
    triangles.push_back(own);
  }
  model.touch_surface.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    model.touch_surface.row(static_cast<Eigen::Index>(i)) = triangles[i];
  }
  model.touch_nodes_m = mesh.nodes_m(kept_nodes, Eigen::all);
}

ModalModel::Rows touchable_rows(const Eigen::MatrixXd& shapes, const FreeDofs& dofs,
                                const std::vector<Eigen::Index>& nodes) {
  ModalModel::Rows rows =
      ModalModel::Rows::Zero(static_cast<Eigen::Index>(3 * nodes.size()), shapes.cols());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int position = dofs.position.at(3 * static_cast<std::size_t>(nodes[i]) + axis);
      if (position >= 0) {
        rows.row(static_cast<Eigen::Index>(3 * i + axis)) = shapes.row(position);
      }
    }
  }
  return rows;
}

std::string key_of(const Fixation& fixation) {
  return fmt::format("{}({:a},{:a},{:a},{},{})", static_cast<int>(fixation.shape),
                     fixation.at_m.x(), fixation.at_m.y(), fixation.radius_m,
                     static_cast<int>(fixation.face), fmt::join(fixation.holds, ""));
}

std::string key_of(const Damping& damping) {
  if (const auto* rayleigh = std::get_if<RayleighDamping>(&damping)) {
    return fmt::format("rayleigh({:a},{:a})", rayleigh->alpha_per_s, rayleigh->beta_s);
  }
  const auto& ratios = std::get<TwoRatioDamping>(damping);
  return fmt::format("ratios({:a},{:a})", ratios.first_ratio, ratios.last_ratio);
}
}  // namespace

std::string content_key(const PlateSpec& plate) {
  std::string key = fmt::format(
      "box({:a},{:a},{:a}) mesh({:a},{:a}) material({:a},{:a},{:a}) damping {} band({:a}) held",
      plate.box.size_m.x(), plate.box.size_m.y(), plate.box.size_m.z(),
      plate.mesh.radius_edge_ratio, plate.mesh.max_tet_volume_m3.value_or(0.0),
      plate.material.youngs_modulus_pa, plate.material.density_kg_per_m3,
      plate.material.poissons_ratio, key_of(plate.material.damping), plate.band_limit_hz);
  for (const Fixation& fixation : plate.fixations) {
    key += " " + key_of(fixation);
  }
  return key;
}

PlateModel build_plate_model(const PlateSpec& plate) {
  check_material(plate.material);
  PlateModel built;
  Stopwatch watch;
  built.mesh = mesh_box(plate.box, plate.mesh, points_to_mesh(plate.fixations, plate.box));
  built.report.cost.mesh_s = watch.lap_s();
  const FreeDofs dofs = free_dofs(held_dofs(built.mesh, plate.box, plate.fixations));
  const StiffnessAndMass matrices = assemble(built.mesh, plate.material, dofs);
  built.report.cost.assemble_s = watch.lap_s();
  const Modes modes = solve_modes(matrices, plate.band_limit_hz);
  built.report.cost.solve_s = watch.lap_s();

  ModalModel& modal = built.modal;
  modal.frequency_hz = modes.omega_rad_s / (2.0 * std::numbers::pi);
  modal.damping = rayleigh_of(plate.material.damping, modes.omega_rad_s);
  modal.damping_ratio = damping_ratios(modal.damping, modes.omega_rad_s);
  std::vector<Eigen::Index> touch_nodes;
  keep_tapped_face(built.mesh, plate.box, modal, touch_nodes);
  modal.shape = touchable_rows(modes.shapes, dofs, touch_nodes);

  built.report.nodes = static_cast<int>(built.mesh.nodes_m.rows());
  built.report.tets = static_cast<int>(built.mesh.tets.rows());
  built.report.dofs = dofs.count;
  built.report.rigid_body_modes = modes.rigid_body_modes;
  built.report.counted_in_band = modes.counted_in_band;
  built.report.worst_residual = modes.worst_residual;
  return built;
}
}  // namespace tapstudy::core
