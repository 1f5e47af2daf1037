#pragma once
#include <cstdint>

#include "core/rng.hpp"
#include "device/haptic_loop.hpp"
#include "device/simulated_hand.hpp"
#include "protocols/protocol.hpp"
#include "runner/model_library.hpp"
#include "runner/participant.hpp"
#include "runner/simulated/observer.hpp"
namespace tapstudy::runner {
// A hand that taps and an observer that judges what the hand felt. Everything it does follows from
// its seed. Before the study it taps the real plates of the protocol to remember them: the plates
// of all answers, ringing at their own frequencies (exact integration); for choices, the
// observer's reference.
class SimulatedParticipant final : public Participant {
 public:
  SimulatedParticipant(const protocols::Protocol& protocol, const device::LoopSettings& settings,
                       ModelLibrary& models, std::uint64_t seed);
  device::Device& hand() { return hand_; }

  std::optional<std::size_t> perform(const Presentation& presentation,
                                     Exploration& exploration) override;

 private:
  std::vector<FeltTap> tap(Exploration& exploration, int count);
  void remember_real_plates(ModelLibrary& models);
  std::size_t choose(const Presentation& presentation, Exploration& exploration);

  const protocols::Protocol& protocol_;
  device::LoopSettings settings_;
  device::SimulatedHand hand_;
  core::Rng hand_rng_;
  SimulatedObserver observer_;
};
}  // namespace tapstudy::runner
