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
// (exact integration).
class SimulatedParticipant final : public Participant {
 public:
  SimulatedParticipant(const protocols::Protocol& protocol, const device::LoopSettings& settings,
                       ModelLibrary& models, std::uint64_t seed);
  device::Device& hand() { return hand_; }

  std::optional<std::size_t> perform(const TrialPrompt& prompt, Exploration& exploration) override;

 private:
  class Touch;
  std::vector<FeltTap> tap(Exploration& exploration, int count);
  void remember_real_stimuli(ModelLibrary& models);

  const protocols::Protocol& protocol_;
  device::LoopSettings settings_;
  device::SimulatedHand hand_;
  core::Rng hand_rng_;
  SimulatedObserver observer_;
};
}  // namespace tapstudy::runner
