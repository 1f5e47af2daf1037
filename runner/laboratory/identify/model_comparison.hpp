#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/modal/modes/model_matching.hpp"
#include "core/model/modal_model.hpp"
#include "core/model/progress.hpp"
#include "core/model/shape/shape.hpp"
#include "protocols/axes/presented_stimulus.hpp"
namespace tapstudy::runner {
// Shapes of measured modes, along z, at the places that were tapped or that moved.
struct MeasuredShapes {
  std::vector<Eigen::Vector2d> places_m;  // plate frame
  Eigen::MatrixXcd shapes;                // at the places, a column for each measured mode
};
inline constexpr std::size_t fewest_places = 3;
inline constexpr const char* told_of_few_places =
    "shapes are not compared: fewer than three places tell none apart";

// The distinct places tapped, in order of appearance, and the number of each impact's place.
struct NumberedPlaces {
  std::vector<Eigen::Vector2d> places_m;
  std::vector<std::size_t> of_impacts;
};
NumberedPlaces numbered(const std::vector<Eigen::Vector2d>& of_impacts_m);

// modal_assurance of each measured mode (rows) and each of the model's (columns), whose shapes are
// displacements of its upper surface along z. Throws InvalidInput for a place beside the body.
Eigen::MatrixXd assurance_of(const MeasuredShapes& measured, const core::ModalModel& model,
                             const core::Shape& body);

// The springs of a plate, all updated by one factor.
struct IdentifiedSprings {
  analysis::Estimate factor;  // on the protocol's
  std::string plate_name;
  std::vector<core::Fixation> fixations;  // all of the plate's, with updated springs
};

// The model of the protocol's stimulus beside what was measured.
struct ModelComparison {
  std::shared_ptr<const protocols::Material> material;
  std::string material_name;
  core::Shape shape;
  std::vector<double> frequencies_hz;  // at the protocol's Young's modulus
  double band_limit_hz{};
  // Of the measured modes (rows) and the model's, of springs as they were found; empty: not known.
  Eigen::MatrixXd assurance;
  std::optional<analysis::ModelUpdate> update;  // unset: no mode has a partner
  bool is_on_springs{false};
  bool is_held_rigidly{false};               // at some fixation, and on no springs
  std::optional<IdentifiedSprings> springs;  // unset: rigid, or the modes do not tell
  std::vector<std::string> doubts;           // sentences: why modes may be matched wrongly
};

struct MeasuredModes {
  std::vector<analysis::Estimate> frequencies_hz;
  std::optional<MeasuredShapes> shapes;     // of the same modes; unset: not known
  std::vector<Eigen::Vector2d> places_m{};  // that were tapped; empty: not known
  double from_hz{0.0};                      // modes below were not sought
};

// Up to the protocol's band limit or high_hz. Throws ModelError if the model cannot be built,
// InvalidInput as assurance_of does.
ModelComparison compare_with_model(const protocols::Protocol& protocol, const std::string& stimulus,
                                   const MeasuredModes& measured, double high_hz,
                                   const core::ProgressHook& progress);
}  // namespace tapstudy::runner
