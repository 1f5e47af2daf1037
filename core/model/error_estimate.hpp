#pragma once
#include "core/model/body_modes.hpp"
#include "core/model/discrete_body.hpp"
#include "core/model/elements/enrichment.hpp"
#include "core/model/joints/coupled_bodies.hpp"
namespace tapstudy::core {
// Unknowns of the larger space times vectors (modes and a few more) up to which an error is
// estimated: 0.7 GB beside the larger space's matrices, which have at most `max_enriched_dofs`.
// Vectors are made orthogonal to each other in every step: hundreds take longer than the model.
inline constexpr double max_enriched_entries = 6e6;
inline constexpr int max_enriched_vectors = 250;
inline constexpr int max_enriched_dofs = 250000;

// How far these modes would fall if the elements were of the next order. Hierarchic a posteriori
// estimate (Zienkiewicz, Gago & Kelly 1983; of eigenvalues Neymeyr 2002). Beyond the bounds above
// it says so instead.
ErrorEstimate estimate_error(const Plate& plate, const Material& material, const DiscreteBody& body,
                             const Modes& modes, const ProgressHook& progress);
// Of joined bodies; `plate` is the one that is tapped, of unit material.
ErrorEstimate estimate_error(const BodySpec& plate, const CoupledBodies& system, const Modes& modes,
                             const ProgressHook& progress);
// Either of them, if it is wanted.
template <class... Of>
ErrorEstimate estimate_if_wanted(ErrorEstimation estimation, const Of&... of) {
  return estimation == ErrorEstimation::wanted ? estimate_error(of...)
                                               : ErrorEstimate{{}, not_asked_for, 0.0};
}
}  // namespace tapstudy::core
