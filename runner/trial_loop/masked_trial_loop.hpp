#pragma once
#include "device/audio/audio_player.hpp"
#include "runner/trial_loop/trial_loop.hpp"
namespace tapstudy::runner {
// Another loop with noise around it, from before its first tick until after its last. What was
// played is in the trial's events: see results::EventRow.
class MaskedTrialLoop final : public TrialLoop {
 public:
  // level_db_fs: of what is played, for the record. A trial of a protocol that requires the noise
  // throws DeviceError once it is lost.
  MaskedTrialLoop(TrialLoop& inner, device::AudioPlayer& player, double level_db_fs,
                  bool is_required)
      : inner_{inner}, player_{player}, level_db_fs_{level_db_fs}, is_required_{is_required} {}
  TrialResult run(const Rendered& rendered, const Explore& explore) override;
  bool is_force_off() const override { return inner_.is_force_off(); }

 private:
  TrialLoop& inner_;
  device::AudioPlayer& player_;
  double level_db_fs_;
  bool is_required_;
  bool has_warned_{false};
};
}  // namespace tapstudy::runner
