#pragma once
#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "core/settings/device_settings.hpp"
#include "device/audio/actuator_player.hpp"
#include "device/audio/audio_player.hpp"
#include "results/store/recorder.hpp"
#include "runner/session/trial_loop/trial_loop.hpp"
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
  // Plays what the actuator renders of each trial; see results::EventRow for what is stored of it.
  void use(device::ActuatorPlayer& actuator) { actuator_ = &actuator; }
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
  device::ActuatorPlayer* actuator_{nullptr};
  Watch watch_;
};

// Another loop with noise around it, from before its first tick until after its last. What was
// played is in the trial's events: see results::EventRow.
class MaskedTrialLoop final : public TrialLoop {
 public:
  struct Noise {
    double level_db_fs;  // of what is played, for the record
    bool is_required;    // by the protocol
    // Told "masking" once its level is reached, "masking_end" as it begins to fade; may be empty.
    std::function<void(std::string_view state, const std::string& detail)> tell{};
  };
  // A trial that requires the noise throws DeviceError once it is lost.
  MaskedTrialLoop(TrialLoop& inner, device::AudioPlayer& player, Noise noise)
      : inner_{inner}, player_{player}, noise_{std::move(noise)} {}
  TrialResult run(const Rendered& rendered, const Explore& explore) override;
  bool is_force_off() const override { return inner_.is_force_off(); }

 private:
  void tell(bool is_heard, std::string_view state, const std::string& detail) const;
  TrialLoop& inner_;
  device::AudioPlayer& player_;
  Noise noise_;
  bool has_warned_{false};
};
}  // namespace tapstudy::runner
