#include "core/model/error_estimate.hpp"

#include <fmt/format.h>

#include <functional>
#include <new>
#include <vector>

#include "core/error.hpp"
#include "core/model/joints/joints.hpp"
#include "core/model/modes/discretisation_error.hpp"
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

ErrorEstimate estimate_error(const BodySpec& plate, const CoupledBodies& system, const Modes& modes,
                             const ProgressHook& progress) {
  int dofs = 0;
  for (const DiscreteBody& body : system.bodies) {
    if (body.order == shell_order) {
      return {{}, "bodies in contact have shell elements, whose shell_width_m may be halved", 0.0};
    }
    dofs += enriched_dofs(body.mesh, body.dofs);
  }
  const auto build = [&] {
    std::vector<EnrichedBody> bodies{
        enriched_body(plate, plate.unit_material(), system.bodies.front())};
    for (std::size_t i = 1; i < system.bodies.size(); ++i) {
      const JoinedBody& other = plate.joints->bodies[i - 1];
      bodies.push_back(enriched_body(other, other.material, system.bodies[i]));
    }
    return joined(bodies, system);
  };
  return estimate_in(dofs, system.matrices, modes, build, progress);
}
}  // namespace tapstudy::core
