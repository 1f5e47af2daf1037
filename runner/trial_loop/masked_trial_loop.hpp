#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "device/audio/audio_player.hpp"
#include "runner/trial_loop/trial_loop.hpp"
namespace tapstudy::runner {
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
