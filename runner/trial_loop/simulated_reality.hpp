#pragma once
#include "protocols/protocol.hpp"
#include "runner/stimuli/model_library.hpp"
#include "runner/trial_loop/real_plates.hpp"
#include "runner/trial_loop/virtual_trial_loop.hpp"
namespace tapstudy::runner {
// The real counterparts of the stimuli: without a technique of their own, vibrating at their true
// natural frequencies. Throws InvalidInput if the technique taken for reality cannot be rendered.
protocols::Protocol with_real_plates(protocols::Protocol protocol);

// What a simulated hand taps in a trial of real plates. Nothing measures them: no trace is kept.
class SimulatedReality final : public RealPlates {
 public:
  SimulatedReality(const protocols::Protocol& protocol, ModelLibrary& models, device::Device& hand,
                   const device::LoopSettings& settings);
  TrialStimuli mount(const std::string& stimulus) override;
  TrialLoop& loop() override { return loop_; }

 private:
  protocols::Protocol reality_;
  ModelLibrary& models_;
  VirtualTrialLoop loop_;
};
}  // namespace tapstudy::runner
