#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "core/random/rng.hpp"
#include "device/hand/simulated_hand.hpp"
#include "device/loop/haptic_loop.hpp"
#include "protocols/protocol.hpp"
#include "runner/session/participants/participant.hpp"
#include "runner/session/participants/simulated_observer.hpp"
#include "runner/session/stimuli/model_library.hpp"
namespace tapstudy::runner {
// A simulated hand that taps and an observer that judges what the hand felt. Fully determined by
// its seed; the task defines how it explores and answers. Before the study it taps the real plates
// required by the protocol's tasks, to memorise them, vibrating at their true natural frequencies
// (exact integration). Participants differ in noise, threshold, speed and bias as the protocol
// states. Where a block's taps are scripted the hand holds still, and real plates are remembered as
// such taps on them feel.
class SimulatedParticipant final : public Participant {
 public:
  SimulatedParticipant(const protocols::Protocol& protocol, const device::LoopSettings& settings,
                       ModelLibrary& models, std::uint64_t seed);
  device::Device& hand() { return hand_; }

  // Throws InvalidInput if its taps can never meet the block's limits.
  void refused(const TrialPrompt& prompt, const TooEarly& why) override;
  void timed_out(const TrialPrompt& prompt, bool is_presented_again) override;
  std::optional<std::string> perform(const TrialPrompt& prompt, TrialControl& control) override;

 private:
  class Touch;
  using Scripted = std::optional<protocols::ScriptedTaps>;
  // Scripted taps and a hand's own do not feel alike: what is known of plates is known by either.
  struct TrainedObserver {
    Scripted taps;
    SimulatedObserver observer;
  };
  double begin_taps(const Scripted& scripted, int count);  // how long they take [s]
  std::vector<FeltTap> just_felt() const;
  std::vector<TrainedObserver> trained_observers(std::uint64_t seed) const;
  void remember(ModelLibrary& models, TrainedObserver& by);
  SimulatedObserver& observer_of(const protocols::Block& block);

  const protocols::Protocol& protocol_;
  protocols::Simulation person_;  // as drawn for this participant
  device::LoopSettings settings_;
  device::SimulatedHand hand_;
  core::Rng hand_rng_;
  std::vector<TrainedObserver> trained_observers_;
  int refused_trial_{0};
  int refusals_{0};
};
}  // namespace tapstudy::runner
