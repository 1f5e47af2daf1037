// Simulated participants.
#include <fmt/format.h>

#include <algorithm>

#include "protocols/reader/read_sections.hpp"
namespace tapstudy::protocols {
namespace {
using Presence = MapReader::Presence;

void read_hand(MapReader& reader, core::HandBody& hand) {
  hand.mass_kg =
      reader.number({"mass_kg", "mass of finger, grip and device"}, {1e-3, 10.0}, hand.mass_kg);
  hand.muscle_stiffness_n_per_m =
      reader.number({"muscle_stiffness_n_per_m", "spring between the hand and the muscle's target"},
                    {1.0, 1e5}, hand.muscle_stiffness_n_per_m);
  hand.muscle_damping_n_s_per_m =
      reader.number({"muscle_damping_n_s_per_m", "damper between the hand and the muscle's target"},
                    {0.0, 1e4}, hand.muscle_damping_n_s_per_m);
}

void read_taps(MapReader& reader, const Protocol& protocol, SimulatedTapSettings& taps) {
  taps.points = reader.words(
      {"points", "names of tapping points, visited in random order; unset: all"}, "tapping point",
      keys_of(protocol.tapping_points_m), keys_of(protocol.tapping_points_m));
  taps.taps_per_visit = reader.integer(
      {"taps_per_visit", "taps per visit; a trial of an identification is one visit"}, 1, 1000,
      taps.taps_per_visit);
  taps.visits =
      reader.integer({"visits", "choice only: visits to each alternative"}, 1, 1000, taps.visits);
  taps.scatter_m = reader.number(
      {"scatter_m", "standard deviation of the tapped position, on the plate, along x and y each"},
      {0.0, 1.0}, taps.scatter_m);
  taps.speed_m_s =
      reader.number({"speed_m_s", "median approach speed"}, {1e-3, 10.0}, taps.speed_m_s);
  taps.speed_spread =
      reader.number({"speed_spread", "standard deviation of the natural logarithm of the speed"},
                    {0.0, 2.0}, taps.speed_spread);
  taps.dwell_s = reader.number({"dwell_s",
                                "median time during which the target stays below the surface: "
                                "feeling a tap takes 0.16 s of contact"},
                               {0.15, 10.0}, taps.dwell_s);
  taps.pause_s = reader.number({"pause_s", "median time to lift and move to the next point"},
                               {0.01, 10.0}, taps.pause_s);
  taps.hover_m =
      reader.number({"hover_m", "height at which a tap starts"}, {1e-3, 0.1}, taps.hover_m);
  taps.press_m = reader.number({"press_m", "depth of the muscle's target below the surface"},
                               {0.0, 0.1}, taps.press_m);
}

// Recordings are of one stimulus, and a beam is one shape.
std::vector<std::string> techniques_of_any_plate() {
  std::vector<std::string> names;
  for (const core::Technique& technique : core::techniques()) {
    if (!technique.has(core::recorded_transient) && !technique.needs_beam()) {
      names.emplace_back(technique.name);
    }
  }
  return names;
}

void read_observer(MapReader& reader, const Protocol& protocol, bool needs_reference,
                   SimulatedObserverSettings& observer) {
  observer.noise_db =
      reader.number({"noise_db", "standard deviation of the internal noise on each felt feature"},
                    {0.0, 1000.0}, observer.noise_db);
  observer.threshold_n =
      reader.number({"threshold_n", "perception threshold: amplitudes well below it are not felt"},
                    Range::positive(10.0), observer.threshold_n);
  observer.familiarisation_taps =
      reader.integer({"familiarisation_taps", "taps on each real plate before the study"}, 4, 1000,
                     observer.familiarisation_taps);
  observer.reality = core::find_technique(reader.word(
      {"reality",
       "how real plates vibrate, whatever the technique of a stimulus: what is remembered of each "
       "body"},
      "technique for plates of any shape", techniques_of_any_plate(),
      std::string{core::natural_vibration().name}));
  if (reader.depends_on_others(needs_reference)) {
    observer.reference = reader.word({"reference",
                                      "stimulus that counts as reality; required if a block is a "
                                      "choice, paired, a ranking or a rating, otherwise unset"},
                                     "stimulus", stimulus_names(protocol));
  }
}

void read_people(MapReader& reader, SimulatedPeopleSettings& people) {
  const Range spread{0.0, 2.0};
  people.noise_spread = reader.number({"noise_spread", "of the logarithm of the internal noise"},
                                      spread, people.noise_spread);
  people.threshold_spread = reader.number({"threshold_spread", "of the logarithm of the threshold"},
                                          spread, people.threshold_spread);
  people.speed_spread = reader.number({"speed_spread", "of the logarithm of the tapping speed"},
                                      spread, people.speed_spread);
  people.bias =
      reader.number({"bias", "towards each answer, in squared units of the internal noise"},
                    {0.0, 10.0}, people.bias);
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
  top.map(
      {"simulation",
       "simulated participants and the simulated hand; required if a block is a choice, paired, a "
       "ranking or a rating"},
      Presence::optional, [&](MapReader& section) {
        section.map({"hand", "finger, grip and device as one mass on a muscle's spring and damper"},
                    Presence::optional,
                    [&](MapReader& reader) { read_hand(reader, simulation.hand); });
        section.map({"taps", "how the hand taps"}, Presence::optional,
                    [&](MapReader& reader) { read_taps(reader, protocol, simulation.taps); });
        section.map({"people",
                     "how simulated participants differ: standard deviations between participants"},
                    Presence::optional,
                    [&](MapReader& reader) { read_people(reader, simulation.people); });
        check_is_there(section, "observer");
        section.map({"observer",
                     "how simulated participants compare stimuli with remembered real plates; "
                     "required if a block is a choice, paired, a ranking or a rating"},
                    Presence::optional, [&](MapReader& reader) {
                      read_observer(reader, protocol, needs_reference, simulation.observer);
                    });
      });
}
}  // namespace tapstudy::protocols
