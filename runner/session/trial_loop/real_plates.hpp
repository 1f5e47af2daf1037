#pragma once
#include <functional>
#include <string>

#include "protocols/protocol.hpp"
#include "runner/session/stimuli/model_library.hpp"
#include "runner/session/trial_loop/trial_loop.hpp"
namespace tapstudy::runner {
// Plates that are mounted for a trial instead of being rendered by the device.
class RealPlates {
 public:
  virtual ~RealPlates() = default;
  // Returns once the plate of this stimulus is in its place, with what the loop is to render of it.
  // Throws Stopped if it cannot be.
  virtual TrialStimuli mount(const std::string& stimulus) = 0;
  virtual TrialLoop& loop() = 0;
};

// Time passes, and that is all: the device exerts no force and measures nothing.
class IdleTrialLoop final : public TrialLoop {
 public:
  TrialResult run(const Rendered& rendered, const Explore& explore) override;
};

// Real plates, which the operator mounts.
class MountedPlates final : public RealPlates {
 public:
  // Returns whether it is done.
  using AskOperator = std::function<bool(const std::string& task)>;
  // loop: an IdleTrialLoop, or one with noise around it.
  MountedPlates(const protocols::Protocol& protocol, AskOperator ask_operator, TrialLoop& loop)
      : protocol_{protocol}, ask_operator_{std::move(ask_operator)}, loop_{loop} {}
  TrialStimuli mount(const std::string& stimulus) override;
  TrialLoop& loop() override { return loop_; }

 private:
  const protocols::Protocol& protocol_;
  AskOperator ask_operator_;
  TrialLoop& loop_;
};

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
