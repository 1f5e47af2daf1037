#include "runner/trial_loop/simulated_reality.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
namespace tapstudy::runner {
protocols::Protocol with_real_plates(protocols::Protocol protocol) {
  protocol.rendering.integrator = core::Integrator::exact;
  const core::Technique* const reality = protocol.simulation.observer.reality;
  if (const auto missing = reality->missing(protocol.rendering); !missing.empty()) {
    throw core::InvalidInput{
        fmt::format("simulation.observer.reality: '{}' needs {}", reality->name, missing)};
  }
  for (protocols::Stimulus& stimulus : protocol.stimuli) {
    stimulus.technique = reality;
    stimulus.rendering.clear();  // a plate has no gain
  }
  return protocol;
}

SimulatedReality::SimulatedReality(const protocols::Protocol& protocol, ModelLibrary& models,
                                   device::Device& hand, const device::LoopSettings& settings)
    : reality_{with_real_plates(protocol)}, models_{models}, loop_{hand, settings, Keep::nothing} {}

TrialStimuli SimulatedReality::mount(const std::string& stimulus) {
  return build_trial_stimuli(reality_, {stimulus}, models_);
}
}  // namespace tapstudy::runner
