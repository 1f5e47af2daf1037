#include "runner/laboratory/identify/model_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <optional>

#include "analysis/modal/modes/mode_shapes.hpp"
#include "analysis/modal/modes/model_matching.hpp"
#include "core/error.hpp"
#include "core/model/plate_model.hpp"
#include "core/model/shape/shape.hpp"
#include "core/tick/vibrating_plate.hpp"
#include "runner/session/stimuli/model_library.hpp"
namespace tapstudy::runner {
namespace {
// Barycentric coordinates of a place in a triangle seen from above; nullopt outside it and for a
// triangle seen edge on.
std::optional<std::array<double, 3>> barycentric(const std::array<Eigen::Vector2d, 3>& corners,
                                                 const Eigen::Vector2d& at) {
  constexpr double rounding = 1e-9;
  const auto area = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                       const Eigen::Vector2d& c) {
    const Eigen::Vector2d u = b - a;
    const Eigen::Vector2d v = c - a;
    return u.x() * v.y() - u.y() * v.x();
  };
  const double whole = area(corners[0], corners[1], corners[2]);
  if (whole <= 0.0) {
    return std::nullopt;
  }
  const std::array<double, 3> parts{area(at, corners[1], corners[2]) / whole,
                                    area(corners[0], at, corners[2]) / whole,
                                    area(corners[0], corners[1], at) / whole};
  return std::ranges::min(parts) < -rounding ? std::nullopt : std::optional{parts};
}

struct TopPlace {
  int triangle{-1};  // below 0: none
  std::array<double, 3> barycentric{};
};

// The triangle there, seen from above, that is nearest to the upper surface.
TopPlace top_place(const core::ModalModel& model, const Eigen::Vector2d& at_m, double z_m) {
  TopPlace found;
  double nearest_m = 0.0;
  for (int triangle = 0; triangle < static_cast<int>(model.touch_surface.rows()); ++triangle) {
    std::array<Eigen::Vector2d, 3> corners;
    double mean_z_m = 0.0;
    for (int i = 0; i < 3; ++i) {
      const auto point = model.touch_nodes_m.row(model.touch_surface(triangle, i));
      corners.at(static_cast<std::size_t>(i)) = point.head<2>().transpose();
      mean_z_m += point.z() / 3.0;
    }
    const double away_m = std::abs(mean_z_m - z_m);
    if (const auto inside = barycentric(corners, at_m);
        inside && (found.triangle < 0 || away_m < nearest_m)) {
      nearest_m = away_m;
      found = {triangle, *inside};
    }
  }
  return found;
}

// Displacement along z per unit of each modal coordinate.
Eigen::RowVectorXd shape_at(const core::ModalModel& model, const TopPlace& place) {
  Eigen::RowVectorXd shape = Eigen::RowVectorXd::Zero(model.frequency_hz.size());
  const core::SurfacePoint point =
      core::surface_point(model.touch_surface, place.triangle, place.barycentric);
  for (std::size_t i = 0; i < point.count; ++i) {
    shape += point.weights[i] * model.shape.row(3 * point.nodes[i] + 2);
  }
  return shape;
}
}  // namespace

NumberedPlaces numbered(const std::vector<Eigen::Vector2d>& of_impacts_m) {
  NumberedPlaces numbered;
  for (const Eigen::Vector2d& at_m : of_impacts_m) {
    const auto known = std::ranges::find(numbered.places_m, at_m);
    numbered.of_impacts.push_back(static_cast<std::size_t>(known - numbered.places_m.begin()));
    if (known == numbered.places_m.end()) {
      numbered.places_m.push_back(at_m);
    }
  }
  return numbered;
}

Eigen::MatrixXd assurance_of(const MeasuredShapes& measured, const core::ModalModel& model,
                             const core::Shape& body) {
  const core::TopHeight top{body};
  Eigen::MatrixXd model_shapes(static_cast<Eigen::Index>(measured.places_m.size()),
                               model.frequency_hz.size());
  for (std::size_t place = 0; place < measured.places_m.size(); ++place) {
    const Eigen::Vector2d& at_m = measured.places_m[place];
    const auto z_m = top.at_m(at_m);
    const TopPlace found = z_m ? top_place(model, at_m, *z_m) : TopPlace{};
    if (found.triangle < 0) {
      throw core::InvalidInput{
          fmt::format("--places: {:g}, {:g} m is not on the body", at_m.x(), at_m.y())};
    }
    model_shapes.row(static_cast<Eigen::Index>(place)) = shape_at(model, found);
  }
  Eigen::MatrixXd assurance(measured.shapes.cols(), model.frequency_hz.size());
  for (Eigen::Index i = 0; i < assurance.rows(); ++i) {
    for (Eigen::Index j = 0; j < assurance.cols(); ++j) {
      assurance(i, j) = analysis::modal_assurance(measured.shapes.col(i),
                                                  model_shapes.col(j).cast<std::complex<double>>());
    }
  }
  return assurance;
}

namespace {
constexpr double further_band = 1.25;  // of the model: its modes may move down into the band

template <class Value>
std::string name_of(const std::map<std::string, std::shared_ptr<const Value>>& all,
                    const std::shared_ptr<const Value>& one) {
  const auto found =
      std::ranges::find_if(all, [&](const auto& entry) { return entry.second == one; });
  return found == all.end() ? std::string{} : found->first;
}

core::PlateSpec on_springs(core::PlateSpec spec, double factor) {
  for (core::Fixation& fixation : spec.fixations) {
    if (fixation.springs_n_per_m) {
      *fixation.springs_n_per_m *= factor;
    }
  }
  return spec;
}

core::ModalModel modes_of(const core::PlateSpec& spec, const core::ProgressHook& progress) {
  return core::build_plate_model(spec, progress).modal;
}

std::vector<double> frequencies_hz(const core::ModalModel& modal) {
  return {modal.frequency_hz.begin(), modal.frequency_hz.end()};
}

Eigen::MatrixXd assurance_if_known(const MeasuredModes& measured, const core::ModalModel& modal,
                                   const core::PlateSpec& spec) {
  return measured.shapes ? assurance_of(*measured.shapes, modal, spec.shape) : Eigen::MatrixXd{};
}

// Modes are matched by frequency alone while the springs are sought; their shapes are told after.
void update_on_springs(const core::PlateSpec& spec, const MeasuredModes& measured,
                       const core::ProgressHook& progress, ModelComparison& model) {
  const auto found = analysis::update_springs(
      measured.frequencies_hz,
      [&](double factor) { return frequencies_hz(modes_of(on_springs(spec, factor), progress)); },
      spec.material.youngs_modulus_pa);
  if (!found) {
    return;
  }
  model.update = found->model;
  if (measured.shapes) {
    const double over_modulus = found->spring_factor.value * spec.material.youngs_modulus_pa /
                                found->model.youngs_modulus_pa.value;
    const core::PlateSpec updated = on_springs(spec, over_modulus);
    model.assurance = assurance_if_known(measured, modes_of(updated, progress), updated);
    for (analysis::MatchedMode& one : model.update->matched) {
      one.assurance = model.assurance(static_cast<Eigen::Index>(one.measured),
                                      static_cast<Eigen::Index>(one.model));
    }
  }
  model.frequencies_hz = found->model_hz;
  model.springs = IdentifiedSprings{
      found->spring_factor, {}, on_springs(spec, found->spring_factor.value).fixations};
}
}  // namespace

ModelComparison compare_with_model(const protocols::Protocol& protocol, const std::string& stimulus,
                                   const MeasuredModes& measured, double high_hz,
                                   const core::ProgressHook& progress) {
  const protocols::Stimulus& stated = protocol.stimulus(stimulus);
  const protocols::PresentedStimulus presented = protocols::stimulus_with(protocol, stated);
  if (presented.contacts) {
    throw core::InvalidInput{fmt::format(
        "stimulus '{}': it touches other bodies, and its frequencies are not those of its material "
        "alone (compare with a stimulus without contacts)",
        stimulus)};
  }
  ModelComparison model;
  model.material = presented.material;
  model.material_name = name_of(protocol.materials, stated.material);
  model.band_limit_hz = protocol.band_limit_hz;
  core::PlateSpec spec = plate_spec(protocol, presented);
  model.shape = spec.shape;
  spec.band_limit_hz = further_band * std::max(spec.band_limit_hz, high_hz);
  spec.material.damping = core::ConstantDamping{};  // only frequencies are compared
  model.is_on_springs = core::is_on_springs(spec.fixations);
  model.is_held_rigidly = !model.is_on_springs && !spec.fixations.empty();
  at_its_line(presented, [&] {
    const core::ModalModel modal = modes_of(spec, progress);
    model.frequencies_hz = frequencies_hz(modal);
    if (measured.frequencies_hz.empty() || model.frequencies_hz.empty()) {
      return;
    }
    model.assurance = assurance_if_known(measured, modal, spec);
    model.update =
        analysis::update_youngs_modulus(measured.frequencies_hz, model.frequencies_hz,
                                        spec.material.youngs_modulus_pa, model.assurance);
    if (model.is_on_springs) {
      update_on_springs(spec, measured, progress, model);
      if (!model.springs) {  // f ~ sqrt(E) would take the springs to grow with E
        model.update.reset();
      }
    }
  });
  if (model.springs) {
    model.springs->plate_name = name_of(protocol.plates, stated.plate);
  }
  return model;
}
}  // namespace tapstudy::runner
