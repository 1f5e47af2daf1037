#pragma once
#include <functional>

#include "protocols/protocol.hpp"
#include "runner/trial_loop/real_plates.hpp"
namespace tapstudy::runner {
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
}  // namespace tapstudy::runner
