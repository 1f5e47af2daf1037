#pragma once
#include <utility>

#include "runner/trial_loop/trial_loop.hpp"
namespace tapstudy::runner {
enum class Keep { trace, events, nothing };

// In virtual time: the loop advances only while the explorer lets time pass, on one thread.
class VirtualTrialLoop final : public TrialLoop {
 public:
  VirtualTrialLoop(device::Device& device, device::LoopSettings settings, Keep keep = Keep::trace)
      : device_{device}, settings_{std::move(settings)}, keep_{keep} {}
  TrialResult run(const Rendered& rendered, const Explore& explore) override;

 private:
  device::Device& device_;
  device::LoopSettings settings_;
  Keep keep_;
};
}  // namespace tapstudy::runner
