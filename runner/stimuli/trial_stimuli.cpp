#include "runner/stimuli/trial_stimuli.hpp"

#include "core/techniques/make_renderer.hpp"
namespace tapstudy::runner {
TrialStimuli build_trial_stimuli(const protocols::Protocol& protocol,
                                 const std::vector<protocols::PresentedStimulus>& stimuli,
                                 ModelLibrary& models) {
  TrialStimuli built;
  for (const protocols::PresentedStimulus& stimulus : stimuli) {
    const ModelLibrary::Plate plate =
        stimulus.technique->needs_model() ? models.plate_of(protocol, stimulus) : nullptr;
    built.plates.push_back(plate);
    built.alternatives.push_back(core::make_renderer(*stimulus.technique, stimulus.rendering,
                                                     touched_shape(stimulus.plate->shape),
                                                     plate.get()));
  }
  return built;
}

TrialStimuli build_trial_stimuli(const protocols::Protocol& protocol,
                                 const std::vector<std::string>& stimuli, ModelLibrary& models) {
  std::vector<protocols::PresentedStimulus> presented;
  for (const std::string& name : stimuli) {
    presented.push_back(stimulus_with(protocol, protocol.stimulus(name)));
  }
  return build_trial_stimuli(protocol, presented, models);
}
}  // namespace tapstudy::runner
