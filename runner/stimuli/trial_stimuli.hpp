#pragma once
#include <string>
#include <vector>

#include "core/tick/tap_renderer.hpp"
#include "protocols/protocol.hpp"
#include "runner/stimuli/model_library.hpp"
namespace tapstudy::runner {
// A trial's alternatives, ready to be rendered, with the models they need.
struct TrialStimuli {
  std::vector<ModelLibrary::Plate> plates;
  std::vector<core::TapRenderer> alternatives;
};

// Of stimuli as they are presented; after ModelLibrary::build_all without meshing or solving.
TrialStimuli build_trial_stimuli(const protocols::Protocol& protocol,
                                 const std::vector<protocols::PresentedStimulus>& stimuli,
                                 ModelLibrary& models);
// Of these, at their own values.
TrialStimuli build_trial_stimuli(const protocols::Protocol& protocol,
                                 const std::vector<std::string>& stimuli, ModelLibrary& models);
}  // namespace tapstudy::runner
