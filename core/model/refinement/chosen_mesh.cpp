#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.hpp"
#include "core/model/element_order.hpp"
#include "core/model/refinement/refinement.hpp"
#include "core/model/refinement/rounds.hpp"
#include "core/model/shells/shell_elements.hpp"
namespace tapstudy::core {
namespace {
// Of a regular tetrahedron.
double edge_m(double volume_m3) {
  return std::cbrt(6.0 * std::numbers::sqrt2 * volume_m3);
}

// In a plate as thick as the edge, once it is flattened, one layer of elements; or shells.
Meshing meshing_with(double edge_m, int order, const Shape& shape) {
  Meshing mesh;
  if (order == shell_order) {
    mesh.shell_width_m = edge_m;
    return mesh;
  }
  mesh.order = order;
  if (const auto* const box = std::get_if<Box>(&shape)) {
    mesh.size.flattening = std::clamp(edge_m / box->size_m.z(), 1.0, max_chosen_flattening);
  }
  const double regular_m3 = edge_m * edge_m * edge_m / (6.0 * std::numbers::sqrt2);
  mesh.size.max_tet_volume_m3 = regular_m3 / mesh.size.flattening;
  return mesh;
}

double first_edge_m(const Shape& shape) {
  if (is_sheet(shape)) {
    return widest_shells_m(shape);
  }
  const double volume_m3 = std::abs(core::volume_m3(shape));
  const double usual_m = edge_m(volume_m3 / tets_of_first_round);
  const auto* const box = std::get_if<Box>(&shape);
  if (box == nullptr || box->size_m.z() > usual_m) {
    return usual_m;
  }
  // Six elements a square of one layer.
  return std::sqrt(6.0 * volume_m3 / (box->size_m.z() * tets_of_first_round));
}

// The next order's modes that this one has above the band count by how far they have to fall.
double error_by_next_order(const BodyModes& modes) {
  const Eigen::Index count = modes.kappa_rad_per_m.size();
  const Eigen::ArrayXd& larger = modes.estimate.kappa_rad_per_m;
  if (!modes.estimate.not_estimated.empty() || larger.size() < count) {
    return HUGE_VAL;
  }
  double error = largest_change(modes.kappa_rad_per_m, larger);
  for (const double further : larger.tail(larger.size() - count)) {
    error = std::max(error, modes.band_limit_rad_per_m / further - 1.0);
  }
  return error;
}

bool is_all_sides(const std::vector<Fixation>& fixations) {
  return std::ranges::all_of(fixations,
                             [](const Fixation& held) { return held.shape == RegionShape::side; });
}

// By which share to shorten the edges: errors of quadratic elements fall with their fourth power
// where the modes are smooth, and more slowly at the rims of what is held.
double shortening(double bound, double accuracy) {
  constexpr double usual_power = 2.5;
  return std::clamp(std::pow(accuracy / bound, 1.0 / usual_power), 0.5, 0.7);
}

class ChosenMesh {
 public:
  ChosenMesh(const BodySpec& body, const SolveMeshed& solve)
      : body_{body},
        solve_{solve},
        accuracy_{body.mesh.accuracy.value_or(usual_accuracy)},
        edge_m_{first_edge_m(body.shape)} {
    check_can_settle(body.fixations, "mesh: auto");
  }

  SolvedBody solved() {
    const int order = is_sheet(body_.shape) ? shell_order : chosen_order;
    if (order == shell_order || !is_enough(solve_with(1))) {
      try {
        while (!is_enough(solve_with(order)) && shorten()) {
        }
      } catch (const ModelError&) {  // too fine for the mesher: the one before it is the finest
        if (rounds_.empty()) {
          throw;
        }
      }
    }
    check_is_fair();
    last_.modes.report.refinement = rounds_;
    last_.modes.report.cost = cost_;
    return std::move(last_);
  }

 private:
  double solve_with(int order) {
    body_.mesh = meshing_with(edge_m_, order, body_.shape);
    SolvedBody next = solve_(body_, ErrorEstimation::wanted);
    add(next.modes.report.cost, cost_);
    const bool is_same_order =
        !rounds_.empty() && last_.modes.report.order() == next.modes.report.order();
    const double moved =
        is_same_order ? largest_change(last_.modes.kappa_rad_per_m, next.modes.kappa_rad_per_m)
                      : HUGE_VAL;
    rounds_.push_back(
        {next.modes.report.tets, static_cast<int>(next.modes.kappa_rad_per_m.size()), moved});
    const auto held_m2 = held_areas_m2(next.mesh, body_.shape, body_.fixations);
    has_settled_ = is_all_sides(body_.fixations) ||
                   (moved <= accuracy_ && nonconverged_region(held_m2_, held_m2).empty());
    held_m2_ = held_m2;
    last_ = std::move(next);
    return error_by_next_order(last_.modes);
  }

  // Without a mode in the band nothing is known of how far it is off, unless a finer mesh has none
  // either.
  bool is_enough(double error) {
    error_ = error;
    const bool is_known =
        rounds_.back().modes > 0 || (rounds_.size() >= 3 && rounds_[rounds_.size() - 2].modes == 0);
    return is_known && has_settled_ && bound() <= accuracy_;
  }

  // What elements of the next order find is half of the error at least (error_estimate.hpp).
  double bound() const { return 2.0 * error_; }

  // False if that would take too many unknowns, or too long.
  bool shorten() {
    constexpr double least = 0.9;  // less is not worth a round
    const bool is_layer = body_.mesh.size.flattening > 1.0 || body_.mesh.shell_width_m;
    const double power = is_layer ? 2.0 : 3.0;  // by which the elements grow in number
    const double room = static_cast<double>(max_automatic_dofs) / last_.modes.report.dofs;
    const double wanted = bound() <= accuracy_ ? 0.6 : shortening(bound(), accuracy_);
    const double share = std::max(wanted, std::pow(room, -1.0 / power));
    edge_m_ *= share;
    return share < least && rounds_.size() < max_rounds;
  }

  // What is far off is refused.
  void check_is_fair() const {
    constexpr double fair = 0.1;
    if (error_ <= fair) {
      return;
    }
    if (rounds_.back().modes == 0) {
      throw ModelError{
          fmt::format("mesh: auto: no mode is found below band_limit_hz with {} unknowns: a body "
                      "this stiff or this small vibrates above it",
                      last_.modes.report.dofs)};
    }
    throw ModelError{fmt::format(
        "mesh: auto: within {} unknowns the frequencies are still {} (smaller or thicker bodies "
        "take fewer; or state order, max_tet_volume_m3 and flattening, at your own time and "
        "memory)",
        max_automatic_dofs,
        std::isfinite(error_) ? fmt::format("too high by about {:.0f} %", 100.0 * error_)
                              : std::string{"off by more than can be estimated"})};
  }

  BodySpec body_;
  const SolveMeshed& solve_;
  double accuracy_;
  double edge_m_;
  double error_{HUGE_VAL};
  bool has_settled_{false};
  std::vector<double> held_m2_;
  std::vector<RefinementRound> rounds_;
  ModelCost cost_;
  SolvedBody last_;
};
}  // namespace

SolvedBody solve_on_chosen_mesh(BodySpec body, const SolveMeshed& solve) {
  return ChosenMesh{body, solve}.solved();
}
}  // namespace tapstudy::core
