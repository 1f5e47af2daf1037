#include "runner/session/trial_loop/real_plates.hpp"

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "core/error.hpp"
#include "runner/terminal/process_exit.hpp"
namespace tapstudy::runner {
namespace {
class IdleExploration final : public Exploration {
 public:
  void request_position(std::size_t /*position*/) override {}
  void request_silence(bool /*is_silent*/) override {}
  bool is_as_requested() const override { return true; }
  void pass_time(double seconds) override {
    std::this_thread::sleep_for(std::chrono::duration<double>{seconds});
  }
  bool is_running() const override { return true; }
  bool is_rendering() const override { return true; }
  double time_s() const override {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  int contacts(std::size_t /*position*/) const override { return 0; }

 private:
  std::chrono::steady_clock::time_point start_{std::chrono::steady_clock::now()};
};
}  // namespace

TrialResult IdleTrialLoop::run(const Rendered& /*rendered*/, const Explore& explore) {
  IdleExploration exploration;
  explore(exploration);
  TrialResult result;
  result.trace.duration_s = exploration.time_s();
  return result;
}

TrialStimuli MountedPlates::mount(const std::string& stimulus) {
  const protocols::Stimulus& plate = protocol_.stimulus(stimulus);
  if (!ask_operator_(fmt::format("For the operator alone: mount the real plate '{}' ({}).",
                                 plate.name, plate.label))) {
    stop_if_asked();
    throw Stopped{fmt::format("stopped: the real plate '{}' was not mounted", plate.name)};
  }
  return {};
}

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
