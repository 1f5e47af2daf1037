#include "runner/simulated/participant.hpp"

#include <set>

#include "runner/rig.hpp"
#include "runner/scene.hpp"
#include "runner/simulated/tap_drawing.hpp"
namespace tapstudy::runner {
namespace {
using core::Purpose;

// The plates that have to be known to answer this protocol's questions.
std::set<std::string> real_plates(const protocols::Protocol& protocol) {
  std::set<std::string> names;
  for (const protocols::Block& block : protocol.blocks) {
    if (block.task == protocols::Task::choice) {
      names.insert(protocol.simulation.observer.reference);
    } else {
      names.insert(block.responses.begin(), block.responses.end());
    }
  }
  return names;
}

// As the stimuli, but real: ringing at their own frequencies.
protocols::Protocol made_real(protocols::Protocol protocol) {
  protocol.rendering.integrator = core::Integrator::exact;
  return protocol;
}

}  // namespace

SimulatedParticipant::SimulatedParticipant(const protocols::Protocol& protocol,
                                           const device::LoopSettings& settings,
                                           ModelLibrary& models, std::uint64_t seed)
    : protocol_{protocol},
      settings_{settings},
      hand_{hand_body(protocol.simulation.hand), protocol.rendering.dt_s,
            device::SimulatedHand::Memory::kept},
      hand_rng_{core::derived_seed(seed, Purpose::memory)},
      observer_{aims_m(protocol, settings.placement), protocol.simulation.observer.noise_db,
                core::Rng{core::derived_seed(seed, Purpose::observer)}} {
  remember_real_plates(models);
  hand_rng_ = core::Rng{core::derived_seed(seed, Purpose::hand)};
}

void SimulatedParticipant::remember_real_plates(ModelLibrary& models) {
  const protocols::Protocol reality = made_real(protocol_);
  VirtualPresenter world{hand_, settings_, Keep::nothing};
  for (const std::string& plate : real_plates(protocol_)) {
    Scene scene = build_scene(reality, {plate}, models);
    world.present(scene.alternatives, [&](Exploration& exploration) {
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

std::optional<std::size_t> SimulatedParticipant::perform(const Presentation& presentation,
                                                         Exploration& exploration) {
  if (presentation.task == protocols::Task::choice) {
    return choose(presentation, exploration);
  }
  const std::vector<FeltTap> felt = tap(exploration, protocol_.simulation.taps.taps_per_visit);
  return observer_.most_alike(felt, presentation.options);
}

// Visits every alternative a few times, in a new random order each time.
std::size_t SimulatedParticipant::choose(const Presentation& presentation,
                                         Exploration& exploration) {
  std::vector<std::vector<FeltTap>> felt(presentation.options.size());
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < felt.size(); ++i) {
    order.push_back(i);
  }
  for (int visit = 0; visit < protocol_.simulation.taps.visits; ++visit) {
    hand_rng_.shuffle(order);
    for (const std::size_t alternative : order) {
      exploration.switch_to(alternative);
      const auto taps = tap(exploration, protocol_.simulation.taps.taps_per_visit);
      felt.at(alternative).insert(felt.at(alternative).end(), taps.begin(), taps.end());
    }
  }
  return observer_.most_alike(felt, protocol_.simulation.observer.reference);
}
}  // namespace tapstudy::runner
