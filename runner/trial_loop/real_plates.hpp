#pragma once
#include <string>

#include "runner/stimuli/trial_stimuli.hpp"
#include "runner/trial_loop/trial_loop.hpp"
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
}  // namespace tapstudy::runner
