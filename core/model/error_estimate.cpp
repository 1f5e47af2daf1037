#include "core/model/error_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <new>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/model/joints/joints.hpp"
#include "core/model/modes/discretisation_error.hpp"
#include "core/model/modes/modal_solver.hpp"
#include "core/model/shells/shell_body.hpp"
#include "core/model/shells/shell_elements.hpp"
namespace tapstudy::core {
namespace {
std::string too_large(int dofs, Eigen::Index vectors) {
  if (dofs <= max_enriched_dofs && vectors <= max_enriched_vectors &&
      static_cast<double>(dofs) * static_cast<double>(vectors) <= max_enriched_entries) {
    return {};
  }
  return fmt::format(
      "elements of the next order have {} unknowns for {} modes, more than the {}, the {} or "
      "the product of {:.0g} to which the error is estimated",
      dofs, vectors, max_enriched_dofs, max_enriched_vectors, max_enriched_entries);
}

EnrichedBody enriched_body(const Plate& plate, const Material& material, const DiscreteBody& body) {
  return enriched(body.mesh, material, body.dofs,
                  spring_supports(body.mesh, plate.shape, plate.fixations));
}

void add_entries(const SparseMatrix& block, int first_row, int first_column,
                 std::vector<Eigen::Triplet<double>>& entries) {
  for (Eigen::Index column = 0; column < block.outerSize(); ++column) {
    for (SparseMatrix::InnerIterator entry{block, column}; entry; ++entry) {
      entries.emplace_back(first_row + static_cast<int>(entry.row()),
                           first_column + static_cast<int>(column), entry.value());
    }
  }
}

SparseMatrix from_entries(const std::vector<Eigen::Triplet<double>>& entries, int rows,
                          int columns) {
  SparseMatrix matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// Springs between bodies pull on the given space's displacements alone: the mean of a region.
EnrichedBody joined(const std::vector<EnrichedBody>& bodies, const CoupledBodies& system) {
  std::vector<Eigen::Triplet<double>> stiffness;
  std::vector<Eigen::Triplet<double>> mass;
  std::vector<Eigen::Triplet<double>> prolongation;
  EnrichedBody all;
  int first = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const EnrichedBody& body = bodies[i];
    add_entries(body.matrices.K, first, first, stiffness);
    add_entries(body.matrices.M, first, first, mass);
    add_entries(body.prolongation, first, system.first_dof[i], prolongation);
    for (const int place : body.place) {
      all.place.push_back(first + place);
    }
    first += static_cast<int>(body.matrices.K.rows());
  }
  for (const Elongation& elongation : system.elongations) {
    for (const auto& [row, a] : elongation.weights) {
      for (const auto& [column, b] : elongation.weights) {
        if (row >= column) {
          stiffness.emplace_back(all.place[static_cast<std::size_t>(row)],
                                 all.place[static_cast<std::size_t>(column)],
                                 elongation.stiffness_n_per_m * a * b);
        }
      }
    }
  }
  all.matrices.K = from_entries(stiffness, first, first);
  all.matrices.M = from_entries(mass, first, first);
  all.prolongation = from_entries(prolongation, first, system.first_dof.back());
  return all;
}

ErrorEstimate estimate_in(int dofs, const StiffnessAndMass& given, const Modes& modes,
                          const std::function<EnrichedBody()>& build,
                          const ProgressHook& progress) {
  Stopwatch watch;
  ErrorEstimate estimate;
  estimate.not_estimated = too_large(dofs, modes.shapes.cols());
  if (!estimate.not_estimated.empty()) {
    return estimate;
  }
  try {
    tell(progress, "estimating the error");
    const EnrichedBody larger = build();
    estimate.kappa_rad_per_m = frequencies_in_larger_space(given, modes, larger, progress);
  } catch (const std::bad_alloc&) {
    estimate.not_estimated = "not enough memory";
  }
  estimate.seconds = watch.elapsed_s();
  return estimate;
}
}  // namespace

ErrorEstimate estimate_error(const Plate& plate, const Material& material, const DiscreteBody& body,
                             const Modes& modes, const ProgressHook& progress) {
  return estimate_in(
      enriched_dofs(body.mesh, body.dofs), body.matrices, modes,
      [&] { return enriched_body(plate, material, body); }, progress);
}

namespace {
bool has_shells(const DiscreteBody& body) {
  return body.order == shell_order;
}

// The given space itself.
EnrichedBody unchanged(const DiscreteBody& body) {
  EnrichedBody same{body.matrices, {}, {}};
  same.place.resize(static_cast<std::size_t>(body.matrices.K.rows()));
  std::iota(same.place.begin(), same.place.end(), 0);
  same.prolongation.resize(body.matrices.K.rows(), body.matrices.K.rows());
  same.prolongation.setIdentity();
  return same;
}

// The same with its shells, on the same triangles, of two orders more.
Eigen::ArrayXd with_finer_shells(const BodySpec& plate, const CoupledBodies& system,
                                 const ProgressHook& progress) {
  constexpr double beyond = 1.05;  // modes at the end of the band may be held otherwise
  std::vector<DiscreteBody> bodies = system.bodies;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (has_shells(bodies[i])) {
      const Plate& body = i == 0 ? plate : static_cast<const Plate&>(plate.joints->bodies[i - 1]);
      const Material material =
          i == 0 ? plate.unit_material() : plate.joints->bodies[i - 1].material;
      std::vector<Fixation> regions = body.fixations;
      const std::vector<Fixation> joined = regions_of(i, *plate.joints);
      regions.insert(regions.end(), joined.begin(), joined.end());
      bodies[i] = shell_body(body, material, shell_order + 2, regions, progress);
    }
  }
  const double limit_hz = beyond * plate.band_limit_rad_per_m / (2.0 * std::numbers::pi);
  return solve_modes(coupled(plate, std::move(bodies), *plate.joints).matrices, limit_hz, progress)
      .omega_rad_s;
}

// What finer shells and what finer tetrahedra lower add up.
void add_drop_of_shells(const BodySpec& plate, const CoupledBodies& system, const Modes& modes,
                        const ProgressHook& progress, ErrorEstimate& estimate) {
  Stopwatch watch;
  const Eigen::ArrayXd finer = with_finer_shells(plate, system, progress);
  Eigen::ArrayXd& others = estimate.kappa_rad_per_m;
  const Eigen::Index both = std::min(finer.size(), others.size());
  const Eigen::Index known = std::min(both, modes.omega_rad_s.size());
  others = others.head(both).eval();
  others.head(known) *= finer.head(known) / modes.omega_rad_s.head(known);
  estimate.seconds += watch.elapsed_s();
}
}  // namespace

ErrorEstimate estimate_error(const BodySpec& plate, const CoupledBodies& system, const Modes& modes,
                             const ProgressHook& progress) {
  if (std::ranges::all_of(system.bodies, has_shells)) {
    Stopwatch watch;
    const Eigen::ArrayXd finer = with_finer_shells(plate, system, progress);
    return {finer, {}, watch.elapsed_s()};
  }
  int dofs = 0;
  for (const DiscreteBody& body : system.bodies) {
    dofs += has_shells(body) ? static_cast<int>(body.matrices.K.rows())
                             : enriched_dofs(body.mesh, body.dofs);
  }
  const auto build = [&] {
    std::vector<EnrichedBody> bodies;
    for (std::size_t i = 0; i < system.bodies.size(); ++i) {
      const DiscreteBody& body = system.bodies[i];
      if (has_shells(body)) {
        bodies.push_back(unchanged(body));
      } else if (i == 0) {
        bodies.push_back(enriched_body(plate, plate.unit_material(), body));
      } else {
        const JoinedBody& other = plate.joints->bodies[i - 1];
        bodies.push_back(enriched_body(other, other.material, body));
      }
    }
    return joined(bodies, system);
  };
  ErrorEstimate estimate = estimate_in(dofs, system.matrices, modes, build, progress);
  if (estimate.not_estimated.empty() && std::ranges::any_of(system.bodies, has_shells)) {
    add_drop_of_shells(plate, system, modes, progress, estimate);
  }
  return estimate;
}
}  // namespace tapstudy::core
