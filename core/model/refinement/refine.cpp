#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/model/element_order.hpp"
#include "core/model/refinement/refinement.hpp"
#include "core/model/refinement/rounds.hpp"
namespace tapstudy::core {
namespace {
constexpr double finer = 0.25;  // ratio of element volume between refinement steps

// The frequencies tracked under refinement: those in the band or, where there are none, the first
// above it, which a finer mesh may bring down into the band. Empty where it is far above.
Eigen::ArrayXd tracked_frequencies(const BodySpec& body, const SolvedBody& solved,
                                   const SolveMeshed& solve) {
  constexpr int max_doublings = 8;
  if (solved.modes.kappa_rad_per_m.size() > 0) {
    return solved.modes.kappa_rad_per_m;
  }
  BodySpec wider = body;
  Eigen::ArrayXd above;
  for (int i = 0; above.size() == 0 && i < max_doublings; ++i) {
    wider.band_limit_rad_per_m *= 2.0;
    above = solve(wider, ErrorEstimation::none).modes.kappa_rad_per_m;
  }
  return above.head(std::min<Eigen::Index>(above.size(), 1));
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
}  // namespace

SolvedBody refine(BodySpec body, const SolveMeshed& solve) {
  const double accuracy = body.mesh.accuracy.value();
  check_can_settle(body.fixations, "mesh.accuracy");
  MeshSize& size = body.mesh.size;
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
    SolvedBody solved = solve(body, ErrorEstimation::wanted);
    body.mesh.order = solved.modes.report.order();  // rounds of one order, so that they compare
    const Eigen::ArrayXd after = tracked_frequencies(body, solved, solve);
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
}  // namespace tapstudy::core
