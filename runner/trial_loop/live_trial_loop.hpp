#pragma once
#include <chrono>
#include <functional>
#include <utility>

#include "core/settings/realtime_request.hpp"
#include "results/recorder.hpp"
#include "runner/trial_loop/trial_loop.hpp"
namespace tapstudy::runner {
// In real time: the loop runs on its own thread, the recorder empties its ring.
class LiveTrialLoop final : public TrialLoop {
 public:
  LiveTrialLoop(device::Device& device, device::LoopSettings settings,
                const core::RealtimeRequest& realtime, results::Recorder& recorder)
      : device_{&device},
        settings_{std::move(settings)},
        realtime_{realtime},
        recorder_{recorder} {}
  // Called with each tick and the time at which it was made, milliseconds later, by whoever drains
  // the ring.
  using Watch = std::function<void(const core::TraceSample& sample,
                                   std::chrono::steady_clock::time_point at)>;
  void watch(Watch watch) { watch_ = std::move(watch); }
  // From the next trial on.
  void use(device::Device& device) { device_ = &device; }
  TrialResult run(const Rendered& rendered, const Explore& explore) override;
  bool is_force_off() const override {
    return stop_ == device::StopOutcome::confirmed || device_->is_force_off();
  }

 private:
  device::Device* device_;
  device::StopOutcome stop_{device::StopOutcome::confirmed};
  device::LoopSettings settings_;
  core::RealtimeRequest realtime_;
  results::Recorder& recorder_;
  Watch watch_;
};
}  // namespace tapstudy::runner
