#pragma once
#include <functional>

#include "core/model/body_modes.hpp"
namespace tapstudy::core {
// One solution on the mesh that the body states.
using SolveMeshed = std::function<SolvedBody(const BodySpec&, ErrorEstimation)>;

// Rounds of a quarter of the elements' volume, until two in a row move no frequency by more than
// the body's accuracy and little is left. Throws ModelError if that is not reached.
SolvedBody refine(BodySpec body, const SolveMeshed& solve);

// Of an automatic mesh that states no accuracy.
inline constexpr double usual_accuracy = 0.02;
// Unknowns up to which an automatic mesh grows: a minute, and its error can still be estimated.
inline constexpr int max_automatic_dofs = 60000;

// Linear elements if they do, else quadratic ones, smaller in each round, until twice the error
// that elements of the next order find is within the accuracy: the estimate is at least half of the
// error (error_estimate.hpp). A plate has one layer of elements, up to `max_chosen_flattening`
// times wider than thick, as long as these do; a sheet shell elements (is_sheet). A held region
// smaller than a side must have settled, too. What does not fit within max_automatic_dofs ends with
// the finest that does: its estimate says what is left. Throws ModelError for points and lines,
// which hold no solid.
SolvedBody solve_on_chosen_mesh(BodySpec body, const SolveMeshed& solve);
inline constexpr double max_chosen_flattening = 8.0;
}  // namespace tapstudy::core
