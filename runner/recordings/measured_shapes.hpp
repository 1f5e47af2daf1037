#pragma once
#include <Eigen/Core>
#include <vector>

#include "core/model/modal_model.hpp"
#include "core/model/shape/shape.hpp"
namespace tapstudy::runner {
// Shapes of measured modes at the places that were tapped.
struct MeasuredShapes {
  std::vector<Eigen::Vector2d> places_m;  // plate frame, each once
  Eigen::MatrixXd shapes;                 // at the places, a column for each measured mode
};
inline constexpr std::size_t fewest_places = 3;

// Of each impact's place the number of the place, in the order in which places come.
struct NumberedPlaces {
  std::vector<Eigen::Vector2d> places_m;
  std::vector<std::size_t> of_impacts;
};
NumberedPlaces numbered(const std::vector<Eigen::Vector2d>& of_impacts_m);

// modal_assurance of each measured mode (rows) and each of the model's (columns), whose shapes are
// displacements of its upper surface along z. Throws InvalidInput for a place beside the body.
Eigen::MatrixXd assurance_of(const MeasuredShapes& measured, const core::ModalModel& model,
                             const core::Shape& body);
}  // namespace tapstudy::runner
