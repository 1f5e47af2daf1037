// Simulated participants.
#include <fmt/format.h>

#include <algorithm>

#include "protocols/reader/read_sections.hpp"
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;

void read_hand(MapReader& reader, core::HandBody& hand) {
  hand.mass_kg = reader.number("mass_kg", {1e-3, 10.0}, hand.mass_kg);
  hand.muscle_stiffness_n_per_m =
      reader.number("muscle_stiffness_n_per_m", {1.0, 1e5}, hand.muscle_stiffness_n_per_m);
  hand.muscle_damping_n_s_per_m =
      reader.number("muscle_damping_n_s_per_m", {0.0, 1e4}, hand.muscle_damping_n_s_per_m);
}

void read_taps(MapReader& reader, const Protocol& protocol, SimulatedTapSettings& taps) {
  taps.points = reader.words("points", "tapping point", keys_of(protocol.tapping_points_m),
                             keys_of(protocol.tapping_points_m));
  taps.taps_per_visit = reader.integer("taps_per_visit", 1, 1000, taps.taps_per_visit);
  taps.visits = reader.integer("visits", 1, 1000, taps.visits);
  taps.scatter_m = reader.number("scatter_m", {0.0, 1.0}, taps.scatter_m);
  taps.speed_m_s = reader.number("speed_m_s", {1e-3, 10.0}, taps.speed_m_s);
  taps.speed_spread = reader.number("speed_spread", {0.0, 2.0}, taps.speed_spread);
  taps.dwell_s = reader.number("dwell_s", {0.15, 10.0}, taps.dwell_s);
  taps.pause_s = reader.number("pause_s", {0.01, 10.0}, taps.pause_s);
  taps.hover_m = reader.number("hover_m", {1e-3, 0.1}, taps.hover_m);
  taps.press_m = reader.number("press_m", {0.0, 0.1}, taps.press_m);
}

void read_observer(MapReader& reader, const Protocol& protocol, bool needs_reference,
                   SimulatedObserverSettings& observer) {
  observer.noise_db = reader.number("noise_db", {0.0, 1000.0}, observer.noise_db);
  observer.threshold_n = reader.number("threshold_n", Range::positive(10.0), observer.threshold_n);
  observer.familiarisation_taps =
      reader.integer("familiarisation_taps", 4, 1000, observer.familiarisation_taps);
  observer.reality =
      core::find_technique(reader.word("reality", "technique", core::technique_names(),
                                       std::string{core::natural_vibration().name}));
  if (observer.reality != nullptr && observer.reality->has(core::recorded_transient)) {
    reader.reject("reality", "is one technique for all stimuli, which recordings are not");
  }
  if (observer.reality != nullptr && observer.reality->needs_beam()) {
    reader.reject("reality", "is the vibration of plates of any shape, which beams are not");
  }
  if (needs_reference) {
    observer.reference = reader.word("reference", "stimulus", stimulus_names(protocol));
  }
}

void read_people(MapReader& reader, SimulatedPeopleSettings& people) {
  const Range spread{0.0, 2.0};
  people.noise_spread = reader.number("noise_spread", spread, people.noise_spread);
  people.threshold_spread = reader.number("threshold_spread", spread, people.threshold_spread);
  people.speed_spread = reader.number("speed_spread", spread, people.speed_spread);
  people.bias = reader.number("bias", {0.0, 10.0}, people.bias);
}
}  // namespace

void read_simulation(MapReader& top, Protocol& protocol) {
  Simulation& simulation = protocol.simulation;
  simulation.taps.points = keys_of(protocol.tapping_points_m);
  const bool needs_reference = std::ranges::any_of(protocol.blocks, [](const Block& block) {
    return block.task != nullptr && block.task->needs_reference();
  });
  const auto check_is_there = [&](MapReader& reader, const char* key) {
    if (needs_reference && !reader.has(key)) {
      reader.reject(
          key, fmt::format("is missing (where no answer is right, simulated participants "
                           "need to know the real one: simulation: {{observer: "
                           "{{reference: {}}}}})",
                           protocol.stimuli.empty() ? "STIMULUS" : protocol.stimuli.front().name));
    }
  };
  check_is_there(top, "simulation");
  top.map("simulation", Presence::optional, [&](MapReader& section) {
    section.map("hand", Presence::optional,
                [&](MapReader& reader) { read_hand(reader, simulation.hand); });
    section.map("taps", Presence::optional,
                [&](MapReader& reader) { read_taps(reader, protocol, simulation.taps); });
    section.map("people", Presence::optional,
                [&](MapReader& reader) { read_people(reader, simulation.people); });
    check_is_there(section, "observer");
    section.map("observer", Presence::optional, [&](MapReader& reader) {
      read_observer(reader, protocol, needs_reference, simulation.observer);
    });
  });
}
}  // namespace tapstudy::protocols
