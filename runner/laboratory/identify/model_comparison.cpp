#include "runner/laboratory/identify/model_comparison.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <iterator>
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

// Unset beside the body.
std::optional<Eigen::RowVectorXd> shape_at(const core::ModalModel& model,
                                           const core::TopHeight& top,
                                           const Eigen::Vector2d& at_m) {
  const auto z_m = top.at_m(at_m);
  const TopPlace found = z_m ? top_place(model, at_m, *z_m) : TopPlace{};
  return found.triangle < 0 ? std::nullopt : std::optional{shape_at(model, found)};
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
    const auto shape = shape_at(model, top, at_m);
    if (!shape) {
      throw core::InvalidInput{
          fmt::format("--places: {:g}, {:g} m is not on the body", at_m.x(), at_m.y())};
    }
    model_shapes.row(static_cast<Eigen::Index>(place)) = *shape;
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
// Modes of the model below the highest matched one that were sought, but that no measured mode is.
std::vector<Eigen::Index> skipped_modes(const ModelComparison& model, double from_hz) {
  const std::vector<analysis::MatchedMode>& matched = model.update->matched;
  const std::size_t highest =
      std::ranges::max_element(matched, {}, &analysis::MatchedMode::model)->model;
  const double factor =
      std::sqrt(model.update->youngs_modulus_pa.value / model.material->youngs_modulus_pa);
  std::vector<Eigen::Index> skipped;
  for (std::size_t mode = 0; mode < highest; ++mode) {
    const bool is_matched =
        std::ranges::find(matched, mode, &analysis::MatchedMode::model) != matched.end();
    if (!is_matched && factor * model.frequencies_hz[mode] > from_hz) {
      skipped.push_back(static_cast<Eigen::Index>(mode));
    }
  }
  return skipped;
}

// Those of the modes that move some of the places along z by a share of the most that they move.
std::vector<Eigen::Index> moving(const std::vector<Eigen::Index>& modes,
                                 const core::ModalModel& modal, const core::Shape& body,
                                 const std::vector<Eigen::Vector2d>& places_m) {
  constexpr double least_share = 0.2;
  const core::TopHeight top{body};
  const Eigen::RowVectorXd most = modal.shape.cwiseAbs().colwise().maxCoeff();
  std::vector<Eigen::Index> seen;
  std::ranges::copy_if(modes, std::back_inserter(seen), [&](Eigen::Index mode) {
    return std::ranges::any_of(places_m, [&](const Eigen::Vector2d& at_m) {
      const auto shape = shape_at(modal, top, at_m);
      return shape && std::abs((*shape)[mode]) > least_share * most[mode];
    });
  });
  return seen;
}

std::string numbers_of(std::vector<Eigen::Index> modes) {
  constexpr std::size_t most_named = 8;
  const bool are_many = modes.size() > most_named;
  modes.resize(std::min(modes.size(), most_named));
  std::ranges::for_each(modes, [](Eigen::Index& mode) { ++mode; });
  return fmt::format("{}{}", fmt::join(modes, ", "), are_many ? " ..." : "");
}

// Of a mode that is misfitted by far more than its interval and than models commonly are; empty:
// there is none.
std::string doubt_of_misfit(const ModelComparison& model, const MeasuredModes& measured,
                            const std::vector<Eigen::Index>& skipped) {
  constexpr double common_misfit = 0.02;
  constexpr double far_beyond = 5.0;  // half-widths
  double worst = common_misfit;
  double half_widths = 0.0;
  for (const analysis::MatchedMode& one : model.update->matched) {
    const analysis::Estimate& hz = measured.frequencies_hz[one.measured];
    const double half = 0.5 * (hz.interval.high - hz.interval.low) / hz.value;
    if (std::abs(one.misfit) > std::max(worst, far_beyond * half)) {
      worst = std::abs(one.misfit);
      half_widths = worst / half;
    }
  }
  if (half_widths == 0.0) {
    return {};
  }
  return fmt::format(
      "the model's frequencies are up to {:.1f} % from those measured, over {} times as far as "
      "these are uncertain{}: are these the model's modes, and is the body as the protocol says?",
      100.0 * worst, far_beyond,
      skipped.empty() ? "" : ", and its modes " + numbers_of(skipped) + " are skipped");
}

std::vector<std::string> doubts_of(const ModelComparison& model, const core::ModalModel& modal,
                                   const MeasuredModes& measured) {
  const std::vector<Eigen::Index> skipped = skipped_modes(model, measured.from_hz);
  std::vector<std::string> doubts;
  if (const std::string doubt = doubt_of_misfit(model, measured, skipped); !doubt.empty()) {
    doubts.push_back(doubt);
  }
  const auto unseen = model.springs ? std::vector<Eigen::Index>{}
                                    // the shapes are of the stated springs
                                    : moving(skipped, modal, model.shape, measured.places_m);
  if (!unseen.empty()) {
    doubts.push_back(
        fmt::format("the model's modes {} lie below the highest that is matched and move what was "
                    "tapped, but none was found for them: are the others the right ones?",
                    numbers_of(unseen)));
  }
  return doubts;
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
    if (model.update) {
      model.doubts = doubts_of(model, modal, measured);
    }
  });
  if (model.springs) {
    model.springs->plate_name = name_of(protocol.plates, stated.plate);
  }
  return model;
}
}  // namespace tapstudy::runner
