#include "runner/stimuli/trial_stimuli.hpp"

#include "core/techniques/make_renderer.hpp"
namespace tapstudy::runner {
TrialStimuli build_trial_stimuli(const protocols::Protocol& protocol,
                                 const std::vector<std::string>& stimuli, ModelLibrary& models) {
  TrialStimuli built;
  for (const std::string& name : stimuli) {
    const protocols::Stimulus& stimulus = protocol.stimulus(name);
    const ModelLibrary::Plate plate =
        stimulus.technique->needs_model() ? models.plate_of(protocol, stimulus) : nullptr;
    built.plates.push_back(plate);
    core::RenderSettings settings = protocol.rendering;
    settings.lateral_ratio = stimulus.plate->lateral_ratio;
    built.alternatives.push_back(core::make_renderer(
        *stimulus.technique, settings, touched_shape(stimulus.plate->shape), plate.get()));
  }
  return built;
}
}  // namespace tapstudy::runner
