#pragma once
#include <stdexcept>

#include "runner/session/trial_loop/real_plates.hpp"
namespace tapstudy::testing {
// For studies that present none.
class NoRealPlates final : public runner::RealPlates {
 public:
  runner::TrialStimuli mount(const std::string& stimulus) override { throw_for(stimulus); }
  runner::TrialLoop& loop() override { throw_for("loop"); }

 private:
  [[noreturn]] static void throw_for(const std::string& what) {
    throw std::logic_error{"no real plates are presented: " + what};
  }
};
}  // namespace tapstudy::testing
