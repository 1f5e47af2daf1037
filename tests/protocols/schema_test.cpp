// The JSON schema that editors use against the reader that decides.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "protocols/reader/read_rig.hpp"
#include "runner/commands/key_reference.hpp"
#include "runner/session/devices/rigs.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/schema_keys.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
struct Change {
  const char* from;
  const char* to;
};

// Surface files are looked for beside it.
std::string every_key_file() {
  return testing::source("tests/data/every_key.yaml");
}

bool reader_accepts(const std::string& text) {
  try {
    protocols::parse_protocol(text, every_key_file());
  } catch (const core::InvalidInput&) {
    return false;
  }
  return true;
}

const std::map<std::string, std::string>& schemas() {
  static const std::map<std::string, std::string> made{
      {"protocol", protocols::protocol_schema()},
      {"rig", runner::rig_schema()},
      {"calibration", runner::calibration_schema()}};
  return made;
}

nlohmann::json parsed(const std::string& schema) {
  return nlohmann::json::parse(schemas().at(schema));
}
std::set<std::string> keys_in(const std::string& schema) {
  return testing::schema_keys(parsed(schema));
}

// By the jsonschema library of Python, which knows nothing of our reader. A line each.
std::vector<std::string> verdicts_of_schema(const std::vector<std::string>& texts,
                                            const std::string& schema = "protocol") {
  const testing::TempDirectory directory;
  std::vector<std::string> command{"/usr/bin/python3",
                                   testing::source("tests/protocols/validate.py"),
                                   directory / "schema.json"};
  testing::write(command.back(), schemas().at(schema));
  for (const std::string& text : texts) {
    command.push_back(directory / (std::to_string(command.size()) + ".yaml"));
    testing::write(command.back(), text);
  }
  const auto result = testing::run_program(command);
  INFO(result.standard_error);
  REQUIRE((result.exit_code == 0 || result.exit_code == 1));
  std::istringstream lines{result.standard_output};
  std::vector<std::string> verdicts;
  for (std::string line; std::getline(lines, line);) {
    verdicts.push_back(line);
  }
  REQUIRE(verdicts.size() == texts.size());
  return verdicts;
}
std::string verdict(bool is_accepted) {
  return is_accepted ? "fits" : "differs";
}
std::string every_key() {
  return testing::contents(every_key_file());
}
}  // namespace

TEST_CASE("the schema has exactly the keys that the reader asks for", "[protocols][schema]") {
  REQUIRE_NOTHROW(protocols::parse_protocol(every_key(), every_key_file()));
  // what stands in a procedure is compared by itself (procedures/read_procedures_test.cpp)
  const auto without_procedures = [](std::set<std::string> keys) {
    std::erase_if(keys,
                  [](const std::string& key) { return key.starts_with("blocks[].procedures[]."); });
    return keys;
  };
  CHECK(without_procedures(keys_in("protocol")) ==
        without_procedures(protocols::keys_asked_for(every_key(), every_key_file())));
}

TEST_CASE("schema and reader accept the same protocols", "[protocols][schema]") {
  const std::vector<Change> changes{
      {"title: {en: Every", "title: {en: Every"},
      {"youngs_modulus_pa: 1.0e10", "youngs_modulus_pa: 10"},
      {"{ratio: 0.02}", "{ratio: 0.02, beta_s: 0}"},
      {"order: 2", "order: 4"},
      {"flattening: 1", "flattening: 0.5"},
      {"mesh: auto", "mesh: automatic"},
      {"mesh: auto", "mesh: {}"},
      {"below_db: 60", "below_db: 5"},
      {"crossover_hz: [200, 280]", "crossover_hz: 200"},
      {"crossover_hz: [200, 280]", "crossover_hz: [0, 280]"},
      {"accuracy: 0.01", "accuracy: 1"},
      {"radius_m: 0.02}", "low_m: [0, 0, 0]}"},
      {"side: left}", "side: under}"},
      {"region: side, side: left", "region: side, side: left, radius_m: 1"},
      {"region: side, side: left", "region: side"},
      {"metres_per_unit: 0.001", "metres_per_unit: 0"},
      {"join_share: 1.0e-5", "join_share: 0.1"},
      {"largest_piece: true", "largest_piece: 1"},
      {"max_triangles: 1000", "max_triangles: 3"},
      {"wrap_m: 0.01, ", ""},
      {"modal_ratios: [0.02, 0.01]", "modal_ratios: []"},
      {"{file: plates.svg, text: The plates}", "{file: plates.svg}"},
      {"{file: plates.svg, text: The plates}", "plates.svg"},
      {"modal_ratios: [0.02, 0.01], further", "further"},
      {"values: [600, 700, 800]", "values: []"},
      {"axis: density_kg_per_m3, values: [600, 700, 800], ", ""},
      {"axis: density_kg_per_m3, values: [600, 700, 800], ", "axis: density_kg_per_m3, "},
      {"modulus: {stimulus: a, number: 10}", "modulus: {stimulus: a, number: 0}"},
      {"modulus: {stimulus: a, number: 10}", "modulus: {number: 10}"},
      {"modulus: {stimulus: a, number: 10}", "steps: 5"},
      {"vote: first", "values: [1]"},
      {"vote: first", "vote: last"},
      {"vote: first", "feedback: true"},
      {"vote: first", "further_axes: [youngs_modulus_pa]"},
      {"vote: first", "response_labels: {a: A}"},
      {"    practice: true\n", ""},
      {"every_trials: 3, ", ""},
      {"steps: 4", "steps: 8"},
      {"at_limit: give_up", "at_limit: forget"},
      {"stimuli: [b, a]\n", "stimuli: [b, a]\n    vote: first\n"},
      {"modal_ratios: [0.02, 0.01]", "modal_ratios: [0.02, 0.01], first_ratio: 0.1"},
      {"modal_ratios: [0.02, 0.01]", "modal_ratios: [0.02], alpha_per_s: 1, beta_s: 1"},
      {"task: choice, ", "task: choice, order: shuffle, "},
      {"more real?\", stimuli: [a, b]", "more real?\", stimuli: [a]"},
      {"title: {en: Every key there is, ja: すべてのキー}\n", ""},
      {"title: {en: Every", "titel: x\ntitle: {en: Every"},
      {"tapstudy/1", "tapstudy/2"},
      {"mass_kg: 0.058", "mass_kg: -1"},
      {"mass_kg: 0.058", "mass_kg: heavy"},
      {"rate_hz: 1000", "rate_hz: 100"},
      {"origin_m: [0, 0, 0]", "origin_m: [0, 0]"},
      {"lateral_scale: 1", "lateral_scale: 0"},
      {"poissons_ratio: 0.25", "poissons_ratio: 0.5"},
      {"poissons_ratio: 0.25", "poissons_ratio: 0.49"},
      {"youngs_moduli_pa: [1.1e10, 7.0e8, 4.0e8]", "youngs_moduli_pa: [1.1e10, 7.0e8]"},
      {"youngs_moduli_pa: [1.1e10, 7.0e8, 4.0e8]", "youngs_moduli_pa: [1.1e10, 7.0e8, 0]"},
      {"    youngs_moduli_pa:", "    youngs_modulus_pa: 1.1e10\n    youngs_moduli_pa:"},
      {"    poissons_ratios: [0.37, 0.42, 0.47]\n", ""},
      {"poissons_ratios: [0.37, 0.42, 0.47]", "poissons_ratio: 0.3"},
      {"shear_moduli_pa: [6.0e8, 5.5e8, 3.5e7]", "shear_moduli_pa: [6.0e8, 5.5e8, -3.5e7]"},
      {"    axes_rotation_rad: [0, 0, 0.1]\n", ""},
      {"axes_rotation_rad: [0, 0, 0.1]", "axes_rotation_rad: 0.1"},
      {"alpha_per_s: 120, beta_s: 7.05e-5", "alpha_per_s: 120"},
      {"first_ratio: 0.2, last_ratio: 0.1", "first_ratio: 0.2"},
      {"first_ratio: 0.2, last_ratio: 0.1", "first_ratio: 0.2, last_ratio: 0.1, beta_s: 0"},
      {"order: 1", "order: 4"},
      {"region: vertex", "region: blob"},
      {"face: through, radius_m: 0.02", "face: through"},
      {"region: vertex, at_m: [-0.3, -0.3]", "region: vertex, radius_m: 1, at_m: [0.3, 0.3]"},
      {"axes: z", "axes: zz"},
      {"springs_n_per_m: [1.0e6, 0, 5.0e5]", "springs_n_per_m: [1.0e6, -1, 5.0e5]"},
      {"springs_n_per_m: [1.0e6, 0, 5.0e5]", "springs_n_per_m: [1.0e6, 5.0e5]"},
      {"springs_n_per_m: [1.0e6, 0, 5.0e5]", "springs_n_per_m: [0, 0, 0]"},
      {"springs_n_per_m: [1.0e6, 0, 5.0e5]", "springs_n_per_m: [1, 1, 1], axes: z"},
      {"springs_n_per_m: [0, 0, 1.0e6]", "springs_n_per_m: [0, 0, -1.0e6]"},
      {"springs_n_per_m: [0, 0, 1.0e6]", "springs_n_per_m: [0, 0, 0]"},
      {"loss_factor: 0.1", "loss_factor: 2.1"},
      {"from: screwed.foot, to: bench.spot", "from: screwed.foot"},
      {"bodies: {bench: {plate: bench, material: oak}}", "bodies: {}"},
      {"    tapped: screwed\n", ""},
      {"spot: {region: vertex, at_m: [0, 0], face: top}",
       "spot: {region: vertex, at_m: [0, 0], axes: z}"},
      {"gap_seconds: 0.4", "gap_seconds: -1"},
      {"intervals: {seconds: 2, ", "intervals: {"},
      {"max_replays: 1}", "max_replays: 0.5}"},
      {"technique: none", "technique: magic"},
      {"technique: none", "technique: recorded"},
      {"technique: none", "technique: none, recording: knock"},
      {"recording: knock", "recording: [knock]"},
      {"rate_hz: 4000", "rate_hz: 0"},
      {"speed_m_s: 0.3, force_n", "speed_m_s: 0, force_n"},
      {"speed_m_s: 0.3, force_n", "force_n"},
      {"force_n: [0.0, 0.1, -0.05, 0.02]", "force_n: []"},
      {"force_n: [0.0, 0.1, -0.05, 0.02]", "force_n: [loud]"},
      {"taps: [{at_m: [0, 0], speed_m_s: 0.3, force_n: [0.0, 0.1, -0.05, 0.02]}]", "taps: []"},
      {"factors: {material: mdf,", "factors: {material: [1],"},
      {"task: identification", "task: guessing"},
      {"stimuli: [b, a]\n", "stimuli: []\n"},
      {"stimuli: [a, b], vote", "stimuli: [a, a], vote"},
      {"responses: [a, b]", "respones: [a, b]"},
      {"repetitions: 2", "repetitions: 2.5"},
      {"order: shuffle", "order: latin"},
      {"order: shuffle", "order: williams"},
      {"max_run: 1", "max_run: 0"},
      {"practice: true", "practice: maybe"},
      {"claim: chosen_above_chance, stimulus: a", "claim: chosen_above_chance"},
      {"factors: [held, seen]", "factors: [held]"},
      {"stimulus: a, to: b, within: 0.5", "stimulus: a, to: b"},
      {"stimulus: a, to: b, within: 0.5", "stimulus: a, to: b, within: 0"},
      {"stimulus: a, to: b, within: 0.5", "stimulus: a, to: b, to_block: marked, within: 0.5"},
      {"to_block: stiffness_by_density, within", "within"},
      {"taps_per_visit: 4", "taps_per_visit: 0"},
      {"noise_db: 9", "noise_db: -9"},
      {"{from: 0.8e10, to: 1.2e10, spacing: log}", "{}"},
      {"{from: 0.8e10, to: 1.2e10, spacing: log}", "[0.8e10, 1.2e10, log]"},
      {"{from: 0.8e10, to: 1.2e10, spacing: log}", "[0.8e10, 1.2e10]"},
      {"{from: 0.8e10, to: 1.2e10, spacing: log}", "[0.8e10]"},
      {"{from: 0.8e10, to: 1.2e10, spacing: log}", "[0.8e10, 1.2e10, log, log]"},
      {"{from: 0.8e10, to: 1.2e10, spacing: log}", "[800, 1.2e10, log]"},
      {"{from: 0.8e10, to: 1.2e10, spacing: log}", "[0.8e10, log, 1.2e10]"},
      {"{from: 0.8e10, to: 1.2e10, spacing: log}", "{from: 0.8e10, to: 1.2e10}"},
      {"{from: 0.8e10, to: 1.2e10, spacing: log}", "{from: 0.8e10}"},
      {"from: 0.8e10, to", "from: 800, to"},
      {"to: 1.2e10, spacing: log", "to: 1.2e10, spacing: octave"},
      {"to: 1.2e10, spacing: log", "to: 1.2e10, count: 3"},
      {"youngs_modulus_pa: {from", "youngs_modulus: {from"},
      {"{from: 600, to: 800", "{from: 0, to: 800"},
      {"{from: 0.5, to: 2,", "{from: 0.5, to: 200,"},
      {"vibration_gain: {from: 0,", "vibration_gain: {from: -1,"},
      {"{from: 0, to: 5,", "{from: 0, to: 5000,"},
      {"{from: 300, to: 900", "{from: 0, to: 900"},
      {"{from: 100, to: 400", "{from: 0, to: 400"},
      {"{from: 1000, to: 4000", "{from: 0, to: 4000"},
      {"{values: [0.25, 0.35]", "{values: [0.25, 0.5]"},
      {"{values: [0.25, 0.35]", "{values: []"},
      {"{values: [0.25, 0.35]", "{values: [0.25, 0.25]"},
      {"{values: [0.25, 0.35]", "{values: [0.25, 0.35], count: 2"},
      {"{from: 0.04, to: 0.06, count: 3", "{from: 0.04, to: 0.06"},
      {"{from: 0.04, to: 0.06, count: 3", "{from: 0.04, to: 0.06, count: 1"},
      {"{from: 0.04, to: 0.06, count: 3", "{from: 0.04, to: 0.06, count: 3, values: [0.05]"},
      {"{values: [0.5, 0.6]", "{values: [0.5, 20]"},
      {"thickness_m: {values: [0.05, 0.06]}", "thickness_m: [0.05, 0.06]"},
      {"standard: 0.8e10", "standard: soft"},
      {"level: fraction", "level: percent"},
      {"comparison: above", "comparison: beside"},
      {"right: comparison", "right: both"},
      {"alternatives: 3\n", "alternatives: 9\n"},
      {"stimuli: [c]\n", "stimuli: [c, d]\n"},
      {"stimuli: [c]\n", "stimuli: [c]\n    repetitions: 2\n"},
      {"rule: weighted", "rule: heavy"},
      {"stimuli: [a, b], alternatives: 4", "stimuli: [a, b], alternatives: 2"},
      {"task: abx, ", "task: abx, order: shuffle, "},
      {"task: abx, ", "task: abx, standard: 2, "},
      {"task: abx, ", "task: abx, steps: 5, "},
      {"settings: {from: 1, to: 4, count: 10, spacing: log}, reference: a", "reference: a"},
      {"settings: {from: 1, to: 4, count: 10, spacing: log}", "settings: {from: 1, to: 4}"},
      {"count: 10, spacing: log", "count: 1"},
      {"count: 10, spacing: log", "count: 101"},
      {"count: 10, spacing: log", "values: [1, 2]"},
      {"count: 10, spacing: log", "count: 10, spacing: cube"},
      {"spacing: log}, reference: a", "spacing: log}, reference: a, standard: 2"},
      {"spacing: log}, reference: a", "spacing: log}, standard: 2"},
      {"spacing: log}, reference: a", "spacing: log}"},
      {"spacing: log}, reference: a", "spacing: log}, reference: a, correction: true"},
      {"spacing: log}, reference: a", "spacing: log}, reference: a, level: fraction"},
      {"spacing: log}, reference: a", "spacing: log}, reference: a, order: listed"},
      {"stimuli: [c], axis: sinusoid_amplitude_n_s_per_m",
       "stimuli: [c, a], axis: sinusoid_amplitude_n_s_per_m"},
      {"vote: first", "settings: {from: 1, to: 4, count: 10}"},
      {"vote: first", "reference: a"},
      {"[a, b, c, d], alternatives: 4", "[a, b, c], alternatives: 4"},
      {"[a, b, c, d], alternatives: 4", "[a, b, c, d], alternatives: 5"},
      {"[a, b, c, d], alternatives: 4", "[a, b, c], alternatives: 3"},
      {"[a, b, c, d], alternatives: 4", "[a, b], alternatives: 3"},
      {"[a, b, c, d], alternatives: 4", "[a, b]"},
      {"[a, b, c, d], alternatives: 4", "[a, b], alternatives: 2"},
      {"[a, b, c, d], alternatives: 4", "[a, b, c, d], order: shuffle"},
      {"[a, b, c, d], alternatives: 4", "[a, b, c, d], right: comparison"},
      {"task: paired, ", "task: paired, presented: real, "},
      {"task: paired, ", "task: paired, feedback: true, "},
      {"steps: 5, low: not at all, high: {en: fully",
       "steps: 12, low: not at all, high: {en: fully"},
      {"{en: fully, ja: 完全に}", "{}"},
      {"{en: fully, ja: 完全に}", "{english: fully}"},
      {"steps: 5, low: not at all, high: {", "steps: 5, high: {"},
      {"response_factor: material\n", ""},
      {"catch_trials: {count: 1, ", "catch_trials: {"},
      {"presented: real", "presented: both"},
      {"correct: 2, of_last: 3", "of_last: 3"},
      {"kind: band", "kind: brown"},
      {"kind: band", "kind: pink"},
      {"kind: band, level_db_fs: -30, band_hz: [100, 1000]", "kind: pink, level_db_fs: -30"},
      {"level_db_fs: -30, band_hz: [100, 1000]", "level_db_fs: -30"},
      {"level_db_fs: -30, ", ""},
      {"level_db_fs: -30", "level_db_fs: -11"},
      {"band_hz: [100, 1000]", "band_hz: [100]"},
      {"band_hz: [100, 1000]", "band_hz: [10, 1000]"},
      {"ramp_s: 0.5", "ramp_s: 0"},
      {"is_required: true", "is_required: 1"},
      {"simulation:\n  hand: {", "simulation:\n  foot: {}\n  hand: {"},
  };
  std::vector<std::string> texts;
  for (const Change& change : changes) {
    texts.push_back(testing::replaced(every_key(), change.from, change.to));
  }
  const std::vector<std::string> verdicts = verdicts_of_schema(texts);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    INFO(changes[i].from << " → " << changes[i].to);
    CHECK(verdict(reader_accepts(texts[i])) == verdicts[i]);
  }
}

namespace {
std::string shipped_rig(const std::string& name) {
  return testing::contents(testing::shipped("rigs/" + name + ".yaml"));
}
std::string calibration() {
  return testing::contents(testing::source("tests/data/spidar_calibration.yaml"));
}
const std::string replay_rig =
    "format: tapstudy-rig/1\ndevice: replay\nmax_force_n: 5\nmax_force_rate_n_per_s: 5000\n"
    "replay: {directory: some_study, trial_id: 1}\n";

// A rig and the calibration that it names, side by side.
bool reader_accepts_rig(const std::string& rig, const std::string& measured = calibration()) {
  const testing::TempDirectory directory;
  testing::write(directory / "spidar_calibration.yaml", measured);
  try {
    runner::parse_rig(rig, directory / "rig.yaml");
  } catch (const core::InvalidInput&) {
    return false;
  }
  return true;
}

struct RigChange {
  const char* rig;
  const char* from;
  const char* to;
};
}  // namespace

TEST_CASE("the schemas of rigs and calibrations have exactly the keys that the reader asks for",
          "[protocols][rig][schema]") {
  const testing::TempDirectory directory;
  testing::write(directory / "spidar_calibration.yaml", calibration());
  std::set<std::string> asked;
  for (const std::string& rig :
       {shipped_rig("spidar_g6") + "audio: {}\nmarkers: {osc: {port: 9000}, lsl: {}, lines: x}\n"
                                   "vibration_response: {points: [{frequency_hz: 9, gain: 1}]}\n"
                                   "actuator: {full_scale_n: 4, response: {points: "
                                   "[{frequency_hz: 9, gain: 1}]}}\n",
        shipped_rig("remote"), replay_rig}) {
    asked.merge(runner::rig_keys_asked_for(rig, directory / "rig.yaml"));
  }
  // these are asked for only where they stand
  asked.insert({"loop.cpu", "vibration_band_hz", "spidar.relay", "spidar.rotary_switch",
                "remote.force_delay_s"});
  CHECK(keys_in("rig") == asked);
  CHECK(keys_in("calibration") ==
        protocols::calibration_keys_asked_for(calibration(), "calibration.yaml"));
}

TEST_CASE("schema and reader accept the same rigs", "[protocols][rig][schema][actuator]") {
  const std::vector<RigChange> changes{
      {"spidar_g6", "format", "format"},
      {"remote", "format", "format"},
      {"simulated_hand", "format", "format"},
      {"replay", "format", "format"},
      {"spidar_g6", "device: spidar-g6", "device: remote"},
      {"remote", "device: remote", "device: simulated_hand"},
      {"spidar_g6", "max_hand_speed_m_s: 1.5\n", ""},
      {"simulated_hand", "max_force_n: 10\n", "max_force_n: 10\nmax_hand_speed_m_s: 1\n"},
      {"simulated_hand", "max_force_n: 10\n", "max_force_n: 0\n"},
      {"simulated_hand", "max_force_n: 10\n", "max_force_n: 1e-300\n"},
      {"simulated_hand", "max_force_n: 10\n", "max_force_n: 10\nloop: {cpu: 1}\n"},
      {"simulated_hand", "max_force_n: 10\n", "max_force_n: 10\nvibration_band_hz: 300\n"},
      {"simulated_hand", "max_force_n: 10\n", "max_force_n: 10\nvibration_band_hz: 0\n"},
      {"simulated_hand", "max_force_n: 10\n",
       "max_force_n: 10\nvibration_response: {points: [{frequency_hz: 9, gain: 0.5}]}\n"},
      {"simulated_hand", "max_force_n: 10\n",
       "max_force_n: 10\nvibration_response: {points: [], max_boost: 2}\n"},
      {"simulated_hand", "max_force_n: 10\n",
       "max_force_n: 10\nvibration_response: {points: [{frequency_hz: 9, gain: 0}]}\n"},
      {"simulated_hand", "max_force_n: 10\n",
       "max_force_n: 10\nvibration_response: {points: [{frequency_hz: 9, gain: 1}], max_boost: "
       "0}\n"},
      {"simulated_hand", "max_force_n: 10\n", "max_force_n: 10\nloop: {cpu: -1}\n"},
      {"simulated_hand", "max_force_n: 10\n", "max_force_n: 10\naudio: {card: \"hw:1,0\"}\n"},
      {"simulated_hand", "max_force_n: 10\n", "max_force_n: 10\naudio: {card: \"\"}\n"},
      {"simulated_hand", "max_force_n: 10\n",
       "max_force_n: 10\naudio: {card: \"file:FILE='|true',FORMAT=raw\"}\n"},
      {"simulated_hand", "max_force_n: 10\n", "max_force_n: 10\naudio: {rate_hz: 1}\n"},
      {"simulated_hand", "max_force_n: 10\n", "max_force_n: 10\nactuator: {full_scale_n: 4}\n"},
      {"simulated_hand", "max_force_n: 10\n", "max_force_n: 10\nactuator: {}\n"},
      {"simulated_hand", "max_force_n: 10\n",
       "max_force_n: 10\nactuator: {full_scale_n: 4, max_gaps: -1}\n"},
      {"simulated_hand", "max_force_n: 10\n",
       "max_force_n: 10\nactuator: {full_scale_n: 4, response: {points: []}}\n"},
      {"simulated_hand", "max_force_n: 10\n",
       "max_force_n: 10\nactuator: {full_scale_n: 4, card: \"file:FILE='|true',FORMAT=raw\"}\n"},
      {"simulated_hand", "max_force_n: 10\n", "max_force_n: 10\naudio: {gain_db: 61}\n"},
      {"simulated_hand", "max_force_n: 10\n", "max_force_n: 10\naudio: {volume: 1}\n"},
      {"simulated_hand", "max_force_n: 10\n", "max_force_n: 10\nmarkers: {osc: {port: 9000}}\n"},
      {"simulated_hand", "max_force_n: 10\n", "max_force_n: 10\nmarkers: {osc: {port: 0}}\n"},
      {"simulated_hand", "max_force_n: 10\n", "max_force_n: 10\nmarkers: {osc: {host: x}}\n"},
      {"simulated_hand", "max_force_n: 10\n", "max_force_n: 10\nmarkers: {lines: \"\"}\n"},
      {"simulated_hand", "max_force_n: 10\n", "max_force_n: 10\nmarkers: {lsl: x}\n"},
      {"spidar_g6", "fifo_priority: 80", "fifo_priority: 100"},
      {"spidar_g6", "lock_memory: true", "lock_memory: 1"},
      {"spidar_g6", "type: X3R,", ""},
      {"spidar_g6", "type: X3R", "type: X3F"},
      {"spidar_g6", "type: X3R", "type: X3R, rotary_switch: 3"},
      {"spidar_g6", "type: X3R", "type: X3R, rotary_switch: 16"},
      {"spidar_g6", "type: X3R", "type: X3R, relay: /dev/ttyACM0"},
      {"spidar_g6", "type: X3R", "type: X3R, relay: \"\""},
      {"spidar_g6", "type: X3R", "type: X3R, amplifier_sensed: false"},
      {"spidar_g6", "type: X3R", "type: X3R, amplifier_sensed: 2"},
      {"spidar_g6", "fifo_priority: 80", "fifo_priority: 80, max_stall_s: 0"},
      {"spidar_g6", "fifo_priority: 80", "fifo_priority: 80, max_stall_s: 0.2"},
      {"spidar_g6", "max_turn_rad: 0.3,", ""},
      {"spidar_g6", "max_turn_rad: 0.3,", "max_turn_rad: 0.6,"},
      {"spidar_g6", "max_reply_s: 0.003}", "max_reply_s: 3}"},
      {"spidar_g6", "force_rise_s: 0.5", "force_rise_s: 0"},
      {"spidar_g6", "lateral_scale: 0.05", "lateral_scale: 0"},
      {"remote", "port: 50607", "port: 80"},
      {"remote", "max_reply_s: 0.003", "max_reply_s: 0"},
      {"remote", "max_reply_s: 0.003", "force_delay_s: 0.002"},
      {"remote", "max_reply_s: 0.003", "force_delay_s: -1"},
      {"remote", "max_reply_s: 0.003", "delay_ticks: 2"},
      {"replay", "trial_id: 1", "trial_id: 0"},
      {"replay", ", trial_id: 1", ""},
  };
  std::vector<std::string> rigs;
  for (const auto& [name, from, to] : changes) {
    rigs.push_back(testing::replaced(std::string{name} == "replay" ? replay_rig : shipped_rig(name),
                                     from, to));
  }
  const std::vector<std::string> verdicts = verdicts_of_schema(rigs, "rig");
  for (std::size_t i = 0; i < changes.size(); ++i) {
    INFO(changes[i].rig << ": " << changes[i].from << " → " << changes[i].to);
    CHECK(verdict(reader_accepts_rig(rigs[i])) == verdicts[i]);
  }
}

TEST_CASE("schema and reader accept the same calibrations", "[protocols][rig][schema]") {
  const std::vector<Change> changes{
      {"format", "format"},
      {"metres_per_count: -1.66555e-5", "metres_per_count: 0"},
      {"metres_per_count: -1.66555e-5", "metres_per_count: 0.01"},
      {"volts_per_newton: 0.3653", "volts_per_newton: 0"},
      {"dac_counts_per_volt: 415", "dac_counts_per_volt: many"},
      {", dac_counts_per_volt: 415", ""},
      {"min_tension_n: 0.3\n", ""},
      {"max_tension_n: 10", "max_tension_n: 21"},
      {"device: spidar-g6", "device: remote"},
      {"  - {metres_per_count: -1.66555e-5, volts_per_newton: 0.3653, dac_counts_per_volt: 415}\n",
       ""},
  };
  std::vector<std::string> texts;
  for (const Change& change : changes) {
    texts.push_back(testing::replaced(calibration(), change.from, change.to));
  }
  const std::vector<std::string> verdicts = verdicts_of_schema(texts, "calibration");
  for (std::size_t i = 0; i < changes.size(); ++i) {
    INFO(changes[i].from << " → " << changes[i].to);
    CHECK(verdict(reader_accepts_rig(shipped_rig("spidar_g6"), texts[i])) == verdicts[i]);
  }
}

TEST_CASE("every protocol and rig that is shipped fits its schema", "[protocols][rig][schema]") {
  for (const auto& [kind, folders] : std::map<std::string, std::vector<std::string>>{
           {"protocol", {"paper", "recommended", "examples"}}, {"rig", {"rigs"}}}) {
    std::vector<std::string> texts;
    for (const std::string& folder : folders) {
      for (const auto& entry : std::filesystem::directory_iterator{testing::shipped(folder)}) {
        if (entry.path().extension() == ".yaml") {
          texts.push_back(testing::contents(entry.path()));
        }
      }
    }
    REQUIRE(texts.size() > 1);
    CHECK(std::ranges::count(verdicts_of_schema(texts, kind), "fits") == std::ssize(texts));
  }
}

namespace {
bool names(const nlohmann::json& required, const std::string& key) {
  return std::ranges::find(required, nlohmann::json(key)) != required.end();
}

// Whatever the other keys of a mapping are, and whether or not they are needed in its place.
bool may_be_missing(const std::string& key, const nlohmann::json& mapping) {
  using nlohmann::json;
  const auto requires_key = [&](const json& rule) {
    const json required = rule.value("then", rule).value("required", json::array());
    const std::string otherwise = rule.value("if", json::object()).value("not", json{}).dump();
    return names(required, key) ||
           (!required.empty() && otherwise.find("[\"" + key + "\"]") != std::string::npos);
  };
  return !requires_key(mapping) &&
         std::ranges::none_of(std::vector{"allOf", "anyOf", "oneOf"}, [&](const char* rules) {
           return std::ranges::any_of(mapping.value(rules, json::array()), requires_key);
         });
}

void collect_gaps(const std::string& path, const nlohmann::json& schema,
                  std::vector<std::string>& gaps) {
  using nlohmann::json;
  const json properties = schema.value("properties", json::object());
  for (const auto& [key, value] : properties.items()) {
    const std::string said = value.value("description", "");
    const bool is_open = may_be_missing(key, schema) && !value.contains("default");
    if (said.empty() || (is_open && said.find("unset") == std::string::npos)) {
      gaps.push_back(path + key);
    }
    collect_gaps(path + key + ".", value, gaps);
  }
  for (const char* const inner : {"items", "additionalProperties"}) {
    if (schema.contains(inner) && schema[inner].is_object()) {
      collect_gaps(path, schema[inner], gaps);
    }
  }
}
}  // namespace

TEST_CASE("every key says what it means and, where it may be missing, what holds without it",
          "[protocols][rig][schema]") {
  std::vector<std::string> gaps;
  for (const auto& [kind, text] : schemas()) {
    collect_gaps(kind + ": ", parsed(kind), gaps);
  }
  CHECK(gaps == std::vector<std::string>{});
}

TEST_CASE("the reference has a row for every key that the schemas have",
          "[protocols][rig][schema]") {
  for (const auto& [kind, text] : schemas()) {
    const std::string reference = runner::key_reference({text});
    for (const std::string& key : keys_in(kind)) {
      const bool is_free = key.ends_with(".*");
      const auto dot = key.rfind('.', is_free ? key.size() - 3 : std::string::npos);
      CAPTURE(key);
      CHECK(reference.find("| `" + key.substr(dot + 1) + "` |") != std::string::npos);
    }
  }
}

TEST_CASE("the line that reads a key is all that schema, reference and refusals know it by",
          "[protocols][schema]") {
  const auto read = [](protocols::MapReader& reader) {
    reader.number({"mass_kg", "mass of the hand"}, {0.0, 10.0}, 1.0);
  };
  const std::string schema = protocols::MapReader::schema_of("hand", "A hand.", read);
  CHECK(nlohmann::json::parse(schema)["properties"] == nlohmann::json::parse(R"({"mass_kg": {
      "type": "number", "minimum": 0, "maximum": 10, "default": 1,
      "description": "mass of the hand"}})"));
  CHECK(runner::key_reference({schema}).find(
            "| `mass_kg` | kg | `1.0` | 0 to 10 | mass of the hand |") != std::string::npos);
  protocols::Problems problems{"hand.yaml"};
  auto reader = protocols::MapReader::whole_file("mas_kg: 2", "hand.yaml", problems);
  read(reader);
  reader.finish();
  CHECK_THROWS_WITH(problems.throw_if_any(),
                    "hand.yaml:1:1: mas_kg: is not a known key (one of: mass_kg, did you mean "
                    "'mass_kg'?)");
}
