#include "runner/participants/simulated_participant.hpp"

#include <set>

#include "runner/participants/tap_drawing.hpp"
#include "runner/stimuli/trial_stimuli.hpp"
#include "runner/trial_loop/virtual_trial_loop.hpp"
namespace tapstudy::runner {
namespace {
using core::Purpose;

// The plates that must be memorised for this protocol's tasks.
std::set<std::string> real_plates(const protocols::Protocol& protocol) {
  std::set<std::string> names;
  for (const protocols::Block& block : protocol.blocks) {
    names.merge([&] {
      const auto of_block = block.task->remembered_plates(block, protocol.simulation);
      return std::set<std::string>{of_block.begin(), of_block.end()};
    }());
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
  std::size_t most_similar_plate(const std::vector<std::string>& plates) override {
    return self_.observer_.most_similar(felt_.front(), plates);
  }
  std::size_t most_similar_alternative(const std::string& plate) override {
    return self_.observer_.most_similar(felt_, plate);
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
  remember_real_plates(models);
  hand_rng_ = core::Rng{core::derived_seed(seed, Purpose::hand)};
}

void SimulatedParticipant::remember_real_plates(ModelLibrary& models) {
  const protocols::Protocol reality = made_real(protocol_);
  VirtualTrialLoop world{hand_, settings_, Keep::nothing};
  for (const std::string& plate : real_plates(protocol_)) {
    TrialStimuli stimuli = build_trial_stimuli(reality, {plate}, models);
    world.run(stimuli.alternatives, [&](Exploration& exploration) {
      observer_.remember(plate,
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
