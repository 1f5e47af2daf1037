#include "core/model/body_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <numbers>
#include <utility>

#include "core/error.hpp"
#include "core/model/beam.hpp"
#include "core/model/discrete_body.hpp"
#include "core/model/element_order.hpp"
#include "core/model/error_estimate.hpp"
#include "core/model/joints/coupled_bodies.hpp"
#include "core/model/joints/joints.hpp"
#include "core/model/modes/modal_solver.hpp"
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
constexpr double tets_of_first_round = 200.0;
constexpr double finer = 0.25;  // ratio of element volume between refinement steps
constexpr std::size_t max_rounds = 8;

void add(const ModelCost& more, ModelCost& to) {
  to.mesh_s += more.mesh_s;
  to.assemble_s += more.assemble_s;
  to.factor_s += more.factor_s;
  to.iterate_s += more.iterate_s;
}

SolvedBody solve_once(const BodySpec& body, const MeshSize& size, ErrorEstimation estimation,
                      const ProgressHook& progress) {
  const Material unit = body.unit_material();
  std::vector<DiscreteBody> discrete{discretised(body, unit, size, {}, progress)};
  DiscreteBody& only = discrete.front();
  const double turn = 2.0 * std::numbers::pi;
  const Modes modes = solve_modes(only.matrices, body.band_limit_rad_per_m / turn, progress);
  SolvedBody solved;
  solved.modes.kappa_rad_per_m = modes.omega_rad_s;
  solved.modes.band_limit_rad_per_m = body.band_limit_rad_per_m;
  solved.modes.report = report_on(discrete, modes);
  solved.modes.estimate = estimate_if_wanted(estimation, body, unit, only, modes, progress);
  solved.displacement = with_constrained_rows(modes.shapes, only.dofs);
  solved.mesh = std::move(only.mesh);
  return solved;
}

// The frequencies tracked under refinement: those in the band or, where there are none, the first
// above it, which a finer mesh may bring down into the band. Empty where it is far above.
Eigen::ArrayXd tracked_frequencies(const BodySpec& body, const MeshSize& size,
                                   const SolvedBody& solved) {
  constexpr int max_doublings = 8;
  if (solved.modes.kappa_rad_per_m.size() > 0) {
    return solved.modes.kappa_rad_per_m;
  }
  BodySpec wider = body;
  Eigen::ArrayXd above;
  for (int i = 0; above.size() == 0 && i < max_doublings; ++i) {
    wider.band_limit_rad_per_m *= 2.0;
    above = solve_once(wider, size, ErrorEstimation::none, {}).modes.kappa_rad_per_m;
  }
  return above.head(std::min<Eigen::Index>(above.size(), 1));
}

double largest_change(const Eigen::ArrayXd& before, const Eigen::ArrayXd& after) {
  const Eigen::Index both = std::min(before.size(), after.size());
  return both == 0 ? 0.0 : (before.head(both) / after.head(both) - 1.0).abs().maxCoeff();
}

// The change that further refinement would still cause: changes shrink by a constant ratio with the
// element size (Richardson 1911). Infinite where they do not shrink.
double remaining_change(double moved_before, double moved) {
  const double ratio = moved / moved_before;
  return ratio < 1.0 ? moved * ratio / (1.0 - ratio) : HUGE_VAL;
}

// The largest error of a frequency by the next element order; infinite if that is not known, or if
// it has further modes in the band.
double estimated_error(const BodyModes& modes) {
  const Eigen::Index count = modes.kappa_rad_per_m.size();
  const Eigen::ArrayXd& larger = modes.estimate.kappa_rad_per_m;
  if (count == 0 || (larger < modes.band_limit_rad_per_m).count() != count) {
    return HUGE_VAL;
  }
  return (modes.kappa_rad_per_m / larger.head(count) - 1.0).maxCoeff();
}

// One small move may be chance: two in a row, and little left, by how the moves shrink or by the
// next element order. Moves that shrink slowly because they are small already leave the latter.
bool has_converged(const std::vector<RefinementRound>& rounds, double estimated, double accuracy) {
  if (rounds.size() < 3) {
    return false;
  }
  const double before = rounds[rounds.size() - 2].moved;
  const double last = rounds.back().moved;
  return std::max(before, last) <= accuracy &&
         std::min(remaining_change(before, last), estimated) <= accuracy;
}

// Where the given triangles are finer than the bound, lowering it would refine nothing.
double next_volume_m3(double bound_m3, const TetMesh& mesh) {
  constexpr double usual = 0.25;  // least ratio of the mean to the bound where it is the bound
  const double mean_m3 = volume_m3(mesh) / static_cast<double>(mesh.tets.rows());
  return finer * std::min(bound_m3, mean_m3 / usual);
}

void check_can_settle(const std::vector<Fixation>& fixations) {
  for (std::size_t i = 0; i < fixations.size(); ++i) {
    if (!can_hold_a_solid(fixations[i])) {
      throw ModelError{fmt::format(
          "mesh.accuracy: fixation {} is a point or a line, under which a solid's frequencies "
          "never settle (hold a disc, a side or a box, or leave accuracy out)",
          i + 1)};
    }
  }
}

// The area held by each fixation must settle as well: a region that keeps catching nodes stiffens
// the body while its elements soften.
std::string nonconverged_region(const std::vector<double>& before_m2,
                                const std::vector<double>& after_m2) {
  constexpr double still = 0.1;
  for (std::size_t i = 0; i < after_m2.size(); ++i) {
    if (after_m2[i] == 0.0) {
      return fmt::format("fixation {} is smaller than the elements: it holds single nodes", i + 1);
    }
    if (i >= before_m2.size() || std::abs(before_m2[i] / after_m2[i] - 1.0) > still) {
      return fmt::format(
          "fixation {} catches more nodes as the mesh is refined: {:.3g} m2, then {:.3g} m2", i + 1,
          i < before_m2.size() ? before_m2[i] : 0.0, after_m2[i]);
    }
  }
  return "";
}

[[noreturn]] void throw_not_converged(const std::vector<RefinementRound>& rounds, double accuracy,
                                      const std::string& unsettled) {
  std::string history;
  for (const RefinementRound& round : rounds) {
    history += fmt::format("; {} tetrahedra: {} modes", round.tets, round.modes);
    history += std::isfinite(round.moved) ? fmt::format(", moved {:.2g} %", 100.0 * round.moved)
                                          : std::string{};
  }
  throw ModelError{
      fmt::format("mesh: the frequencies have not settled to {} % within {:.0g} tetrahedra, {:.0g} "
                  "unknowns and "
                  "{} rounds{}{} (ask for less, or leave accuracy out and give a size)",
                  100.0 * accuracy, max_tets, static_cast<double>(max_chosen_dofs), max_rounds,
                  history, unsettled.empty() ? "" : "; " + unsettled)};
}

SolvedBody refine(BodySpec body, const ProgressHook& progress) {
  const double accuracy = body.mesh.accuracy.value();
  check_can_settle(body.fixations);
  MeshSize size = body.mesh.size;
  double volume_m3 =
      size.max_tet_volume_m3.value_or(std::abs(core::volume_m3(body.shape)) / tets_of_first_round);
  std::vector<RefinementRound> rounds;
  ModelCost cost;
  Eigen::ArrayXd before;
  std::vector<double> held_before_m2;
  std::string unsettled;
  int dofs = 0;
  while (rounds.size() < max_rounds && dofs <= finer * max_chosen_dofs &&
         (rounds.empty() || rounds.back().tets <= finer * max_tets)) {
    size.max_tet_volume_m3 = volume_m3;
    SolvedBody solved = solve_once(body, size, ErrorEstimation::wanted, progress);
    body.mesh.order = solved.modes.report.order();  // rounds of one order, so that they compare
    const Eigen::ArrayXd after = tracked_frequencies(body, size, solved);
    dofs = solved.modes.report.dofs;
    add(solved.modes.report.cost, cost);
    const double moved = rounds.empty() ? HUGE_VAL : largest_change(before, after);
    rounds.push_back(
        {solved.modes.report.tets, static_cast<int>(solved.modes.kappa_rad_per_m.size()), moved});
    const auto held_m2 = held_areas_m2(solved.mesh, body.shape, body.fixations);
    unsettled = nonconverged_region(held_before_m2, held_m2);
    held_before_m2 = held_m2;
    const bool is_far_above = rounds.size() > 1 && before.size() == 0 && after.size() == 0;
    if (is_far_above || (before.size() == after.size() && unsettled.empty() &&
                         has_converged(rounds, estimated_error(solved.modes), accuracy))) {
      solved.modes.report.refinement = rounds;
      solved.modes.report.cost = cost;
      return solved;
    }
    before = after;
    volume_m3 = next_volume_m3(volume_m3, solved.mesh);
  }
  throw_not_converged(rounds, accuracy, unsettled);
}
}  // namespace

std::string content_key(const Plate& plate) {
  std::string key = fmt::format(
      "{} mesh(order {},{:a},{:a},{:a},{:a}) held", content_key(plate.shape), plate.mesh.order,
      plate.mesh.size.radius_edge_ratio, plate.mesh.size.max_tet_volume_m3.value_or(0.0),
      plate.mesh.size.flattening, plate.mesh.accuracy.value_or(0.0));
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
    SolvedBody solved = body.mesh.accuracy ? refine(body, progress)
                                           : solve_once(body, body.mesh.size, estimation, progress);
    keep_touchable_part(body.shape, solved);
    return solved;
  } catch (const std::bad_alloc&) {
    throw ModelError{"modes: not enough memory for so fine a mesh (choose larger elements)"};
  }
}
}  // namespace tapstudy::core
