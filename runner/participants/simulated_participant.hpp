#pragma once
#include <cstdint>

#include "core/rng.hpp"
#include "device/hand/simulated_hand.hpp"
#include "device/loop/haptic_loop.hpp"
#include "protocols/protocol.hpp"
#include "runner/participants/participant.hpp"
#include "runner/participants/simulated_observer.hpp"
#include "runner/stimuli/model_library.hpp"
namespace tapstudy::runner {
// A simulated hand that taps and an observer that judges what the hand felt. Fully determined by
// its seed; the task defines how it explores and answers. Before the study it taps the real plates
// required by the protocol's tasks, to memorise them, vibrating at their true natural frequencies
// (exact integration). Participants differ in noise, threshold, speed and bias as the protocol
// states.
class SimulatedParticipant final : public Participant {
 public:
  SimulatedParticipant(const protocols::Protocol& protocol, const device::LoopSettings& settings,
                       ModelLibrary& models, std::uint64_t seed);
  device::Device& hand() { return hand_; }

  // Throws InvalidInput if its taps can never meet the block's limits.
  void refused(const TrialPrompt& prompt, const TooEarly& why) override;
  void timed_out(const TrialPrompt& prompt, bool is_presented_again) override;
  std::optional<std::string> perform(const TrialPrompt& prompt, Exploration& exploration) override;

 private:
  class Touch;
  std::vector<FeltTap> tap(Exploration& exploration, int count);
  void remember(ModelLibrary& models);

  const protocols::Protocol& protocol_;
  protocols::Simulation person_;  // as drawn for this participant
  device::LoopSettings settings_;
  device::SimulatedHand hand_;
  core::Rng hand_rng_;
  SimulatedObserver observer_;
  int refused_trial_{0};
  int refusals_{0};
};
}  // namespace tapstudy::runner
