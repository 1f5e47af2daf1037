#include "runner/recordings/model_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/modal_identification/spring_update.hpp"
#include "core/error.hpp"
#include "core/model/plate_model.hpp"
#include "runner/stimuli/at_its_line.hpp"
#include "runner/stimuli/model_library.hpp"
namespace tapstudy::runner {
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
    const Eigen::MatrixXd assurance =
        assurance_if_known(measured, modes_of(updated, progress), updated);
    for (analysis::MatchedMode& one : model.update->matched) {
      one.assurance =
          assurance(static_cast<Eigen::Index>(one.measured), static_cast<Eigen::Index>(one.model));
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
    model.update = analysis::update_youngs_modulus(measured.frequencies_hz, model.frequencies_hz,
                                                   spec.material.youngs_modulus_pa,
                                                   assurance_if_known(measured, modal, spec));
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
