#include "runner/participants/simulated_participant.hpp"

#include <algorithm>
#include <set>

#include "runner/participants/tap_drawing.hpp"
#include "runner/stimuli/trial_stimuli.hpp"
#include "runner/trial_loop/virtual_trial_loop.hpp"
namespace tapstudy::runner {
namespace {
using core::Purpose;

// The stimuli that must be memorised for this protocol's tasks.
std::set<std::string> remembered_stimuli(const protocols::Protocol& protocol) {
  std::set<std::string> names;
  for (const protocols::Block& block : protocol.blocks) {
    const auto of_block = block.task->remembered_stimuli(block, protocol.simulation);
    names.insert(of_block.begin(), of_block.end());
  }
  return names;
}

// The real counterparts of the stimuli: vibrating at their true natural frequencies.
protocols::Protocol made_real(protocols::Protocol protocol) {
  protocol.rendering.integrator = core::Integrator::exact;
  return protocol;
}
}  // namespace

// One trial: what was felt of each alternative.
class SimulatedParticipant::Touch final : public protocols::SimulatedTouch {
 public:
  Touch(SimulatedParticipant& self, std::size_t alternatives, Exploration& exploration)
      : self_{self}, exploration_{exploration}, felt_(alternatives) {}
  void visit(std::size_t alternative) override {
    if (felt_.size() > 1) {
      exploration_.switch_to(alternative);
    }
    const auto taps = self_.tap(exploration_, self_.protocol_.simulation.taps.taps_per_visit);
    felt_.at(alternative).insert(felt_.at(alternative).end(), taps.begin(), taps.end());
  }
  std::size_t most_similar_stimulus(const std::vector<std::string>& stimuli) override {
    return self_.observer_.most_similar(felt_.front(), stimuli);
  }
  std::size_t most_similar_alternative(const std::string& stimulus) override {
    return self_.observer_.most_similar(felt_, stimulus);
  }
  core::Rng& rng() override { return self_.hand_rng_; }

 private:
  SimulatedParticipant& self_;
  Exploration& exploration_;
  std::vector<std::vector<FeltTap>> felt_;
};

SimulatedParticipant::SimulatedParticipant(const protocols::Protocol& protocol,
                                           const device::LoopSettings& settings,
                                           ModelLibrary& models, std::uint64_t seed)
    : protocol_{protocol},
      settings_{settings},
      hand_{protocol.simulation.hand, protocol.rendering.dt_s, device::SimulatedHand::Memory::kept},
      hand_rng_{core::derived_seed(seed, Purpose::memory)},
      observer_{aims_m(protocol, settings.placement), protocol.simulation.observer.noise_db,
                core::Rng{core::derived_seed(seed, Purpose::observer)}} {
  remember_real_stimuli(models);
  hand_rng_ = core::Rng{core::derived_seed(seed, Purpose::hand)};
}

void SimulatedParticipant::remember_real_stimuli(ModelLibrary& models) {
  const protocols::Protocol reality = made_real(protocol_);
  VirtualTrialLoop world{hand_, settings_, Keep::nothing};
  for (const std::string& stimulus : remembered_stimuli(protocol_)) {
    TrialStimuli stimuli = build_trial_stimuli(reality, {stimulus}, models);
    world.run(stimuli.alternatives, [&](Exploration& exploration) {
      observer_.remember(stimulus,
                         tap(exploration, protocol_.simulation.observer.familiarisation_taps));
    });
  }
}

std::vector<FeltTap> SimulatedParticipant::tap(Exploration& exploration, int count) {
  hand_.forget();
  exploration.pass_time(hand_.follow(draw_taps(protocol_, settings_.placement, count, hand_rng_)));
  return felt_taps(hand_.felt(), protocol_.rendering.dt_s,
                   protocol_.simulation.observer.threshold_n);
}

std::optional<std::size_t> SimulatedParticipant::perform(const TrialPrompt& prompt,
                                                         Exploration& exploration) {
  const std::size_t alternatives = std::max<std::size_t>(1, prompt.alternative_labels.size());
  Touch touch{*this, alternatives, exploration};
  return prompt.task->simulated_answer(prompt.options, protocol_.simulation, touch);
}
}  // namespace tapstudy::runner
