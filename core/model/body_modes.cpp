#include "core/model/body_modes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <numbers>
#include <utility>

#include "core/error.hpp"
#include "core/model/beam.hpp"
#include "core/model/cubic_elements.hpp"
#include "core/model/discrete_body.hpp"
#include "core/model/element_order.hpp"
#include "core/model/elements/enrichment.hpp"
#include "core/model/error_estimate.hpp"
#include "core/model/fixation.hpp"
#include "core/model/joints/coupled_bodies.hpp"
#include "core/model/joints/joints.hpp"
#include "core/model/modes/modal_solver.hpp"
#include "core/model/refinement/refinement.hpp"
#include "core/model/shells/shell_body.hpp"
#include "core/model/shells/shell_elements.hpp"
namespace tapstudy::core {
// Extracts the touchable part of a solved body: the upper face of a box, the entire surface of any
// other solid. Nodes are renumbered from 0.
void keep_touchable_part(const Shape& shape, SolvedBody& solved);

namespace {
bool is_touchable(const TetMesh& mesh, Eigen::Index triangle, const Shape& shape) {
  if (!std::holds_alternative<Box>(shape)) {
    return true;
  }
  const Bounds body = bounds(shape);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double z_m = mesh.nodes_m(mesh.surface(triangle, i), 2);
    if (std::abs(z_m - body.high_m.z()) > body.snap_m()) {
      return false;
    }
  }
  return true;
}
}  // namespace

void keep_touchable_part(const Shape& shape, SolvedBody& solved) {
  const TetMesh& mesh = solved.mesh;
  std::vector<int> renumbered(static_cast<std::size_t>(mesh.nodes_m.rows()), -1);
  std::vector<int> kept_nodes;
  std::vector<Eigen::Index> kept_triangles;
  for (Eigen::Index triangle = 0; triangle < mesh.surface.rows(); ++triangle) {
    if (!is_touchable(mesh, triangle, shape)) {
      continue;
    }
    kept_triangles.push_back(triangle);
    for (const int node : mesh.surface.row(triangle)) {
      int& number = renumbered[static_cast<std::size_t>(node)];
      if (number < 0) {
        number = static_cast<int>(kept_nodes.size());
        kept_nodes.push_back(node);
      }
    }
  }
  BodyModes& modes = solved.modes;
  modes.touch_surface = mesh.surface(kept_triangles, Eigen::all).unaryExpr([&](int node) {
    return renumbered[static_cast<std::size_t>(node)];
  });
  modes.touch_nodes_m = mesh.nodes_m(kept_nodes, Eigen::all);
  modes.shape.resize(3 * modes.touch_nodes_m.rows(), solved.displacement.cols());
  for (std::size_t i = 0; i < kept_nodes.size(); ++i) {
    modes.shape.middleRows(static_cast<Eigen::Index>(3 * i), 3) =
        solved.displacement.middleRows(Eigen::Index{3} * kept_nodes[i], 3);
  }
}

namespace {
// Modes in the space of cubic elements on the same tetrahedra; of their shapes what moves T10's
// nodes, which the other unknowns do not.
Modes cubic_modes(const BodySpec& body, DiscreteBody& discrete, double band_limit_hz,
                  const ProgressHook& progress) {
  Stopwatch watch;
  tell(progress, fmt::format("assembling {} cubic tetrahedra", discrete.mesh.tets.rows()));
  const EnrichedBody cubic = enriched(discrete.mesh, body.unit_material(), discrete.dofs,
                                      spring_supports(discrete.mesh, body.shape, body.fixations));
  discrete.cost.assemble_s += watch.lap_s();
  Modes modes = solve_modes(cubic.matrices, band_limit_hz, progress);
  modes.shapes = modes.shapes(cubic.place, Eigen::all).eval();
  return modes;
}

// The same triangles with elements of two orders more, a little beyond the band: their modes there
// may be held otherwise.
ErrorEstimate estimate_of_shells(const BodySpec& body, double band_limit_hz,
                                 const ProgressHook& progress) {
  constexpr double beyond = 1.05;
  Stopwatch watch;
  const DiscreteBody finer =
      shell_body(body, body.unit_material(), shell_order + 2, body.fixations, progress);
  ErrorEstimate estimate;
  estimate.kappa_rad_per_m =
      solve_modes(finer.matrices, beyond * band_limit_hz, progress).omega_rad_s;
  estimate.seconds = watch.elapsed_s();
  return estimate;
}

SolvedBody solve_once(const BodySpec& body, ErrorEstimation estimation,
                      const ProgressHook& progress) {
  const Material unit = body.unit_material();
  std::vector<DiscreteBody> discrete{discretised(body, unit, body.mesh.size, {}, progress)};
  DiscreteBody& only = discrete.front();
  const double limit_hz = body.band_limit_rad_per_m / (2.0 * std::numbers::pi);
  const bool is_cubic = body.mesh.order == cubic_order;
  const Modes modes = is_cubic ? cubic_modes(body, only, limit_hz, progress)
                               : solve_modes(only.matrices, limit_hz, progress);
  SolvedBody solved;
  solved.modes.kappa_rad_per_m = modes.omega_rad_s;
  solved.modes.band_limit_rad_per_m = body.band_limit_rad_per_m;
  solved.modes.report = report_on(discrete, modes);
  if (is_cubic) {
    solved.modes.report.bodies.front().order = cubic_order;
    solved.modes.report.dofs = enriched_dofs(only.mesh, only.dofs);
    solved.modes.estimate.not_estimated =
        "there are no elements above order 3 (an accuracy compares with a coarser mesh)";
  } else if (body.mesh.shell_width_m && estimation == ErrorEstimation::wanted) {
    solved.modes.estimate = estimate_of_shells(body, limit_hz, progress);
  } else {
    solved.modes.estimate = estimate_if_wanted(estimation, body, unit, only, modes, progress);
  }
  solved.modes.estimate.held_in_part =
      fmt::format("{}", fmt::join(held_in_part(only.mesh, body.shape, body.fixations), "; "));
  solved.displacement = only.displacement * modes.shapes;
  solved.mesh = std::move(only.mesh);
  return solved;
}
}  // namespace

std::string content_key(const Plate& plate) {
  std::string key = fmt::format(
      "{} mesh(order {},{:a},{:a},{:a},{:a}) held", content_key(plate.shape), plate.mesh.order,
      plate.mesh.size.radius_edge_ratio, plate.mesh.size.max_tet_volume_m3.value_or(0.0),
      plate.mesh.size.flattening, plate.mesh.accuracy.value_or(0.0));
  key += plate.mesh.shell_width_m ? fmt::format(" shells({:a})", *plate.mesh.shell_width_m) : "";
  key += plate.mesh.is_automatic ? " automatic" : "";
  for (const Fixation& fixation : plate.fixations) {
    key += " " + content_key(fixation);
  }
  key += plate.theory == Theory::beam ? " as a beam" : "";
  return key;
}

std::string content_key(const BodySpec& body) {
  return fmt::format("{} poisson({:a}){} band({:a}) {}",
                     content_key(static_cast<const Plate&>(body)), body.poissons_ratio,
                     content_key(body.orthotropy), body.band_limit_rad_per_m,
                     body.joints ? content_key(*body.joints) : "");
}

SolvedBody solve_body(const BodySpec& body, const ProgressHook& progress,
                      ErrorEstimation estimation) {
  if (body.theory == Theory::beam) {
    return {{}, {}, beam_modes(body)};
  }
  try {
    if (body.joints) {
      SolvedBody solved = solve_joined_bodies(body, progress, estimation);
      keep_touchable_part(body.shape, solved);
      return solved;
    }
    const SolveMeshed solve = [&](const BodySpec& meshed, ErrorEstimation wanted) {
      return solve_once(meshed, wanted, progress);
    };
    SolvedBody solved = body.mesh.is_automatic ? solve_on_chosen_mesh(body, solve)
                        : body.mesh.accuracy   ? refine(body, solve)
                                               : solve_once(body, estimation, progress);
    keep_touchable_part(body.shape, solved);
    return solved;
  } catch (const std::bad_alloc&) {
    throw ModelError{"modes: not enough memory for so fine a mesh (choose larger elements)"};
  }
}
}  // namespace tapstudy::core
