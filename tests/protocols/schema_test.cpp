// The JSON schema that editors use against the reader that decides.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "core/error.hpp"
#include "protocols/read_protocol.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
void collect(const nlohmann::json& schema, const std::string& path, std::set<std::string>& keys) {
  if (schema.contains("properties")) {
    for (const auto& [key, inner] : schema["properties"].items()) {
      const std::string own = path.empty() ? key : path + "." + key;
      keys.insert(own);
      collect(inner, own, keys);
    }
  }
  if (schema.contains("additionalProperties") && schema["additionalProperties"].is_object()) {
    // names of mappings are free and not themselves keys; names of values are
    const nlohmann::json& value = schema["additionalProperties"];
    if (!value.contains("properties")) {
      keys.insert(path + ".*");
    }
    collect(value, path + ".*", keys);
  }
  if (schema.contains("items") && schema["items"].contains("properties")) {
    collect(schema["items"], path + "[]", keys);
  }
}

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

// By the jsonschema library of Python, which knows nothing of our reader.
bool schema_accepts(const std::string& text) {
  const testing::TempDirectory directory;
  testing::write(directory / "study.yaml", text);
  const auto result = testing::run_program(
      {"/usr/bin/python3", testing::source("tests/protocols/validate.py"),
       testing::shipped("schema/protocol.schema.json").string(), directory / "study.yaml"});
  INFO(result.standard_error);
  REQUIRE((result.exit_code == 0 || result.exit_code == 1));
  return result.exit_code == 0;
}
std::string every_key() {
  return testing::contents(every_key_file());
}
}  // namespace

TEST_CASE("the schema has exactly the keys that the reader asks for", "[protocols][schema]") {
  REQUIRE_NOTHROW(protocols::parse_protocol(every_key(), every_key_file()));
  std::set<std::string> in_schema;
  collect(nlohmann::json::parse(testing::contents(testing::shipped("schema/protocol.schema.json"))),
          "", in_schema);
  CHECK(in_schema == protocols::keys_asked_for(every_key(), every_key_file()));
}

TEST_CASE("schema and reader accept the same protocols", "[protocols][schema][slow]") {
  struct Change {
    const char* from;
    const char* to;
  };
  const auto [from, to] = GENERATE(values<Change>({
      {"title: Every", "title: Every"},
      {"order: 2", "order: 3"},
      {"flattening: 1", "flattening: 0.5"},
      {"accuracy: 0.01", "accuracy: 1"},
      {"radius_m: 0.02}", "low_m: [0, 0, 0]}"},
      {"side: left}", "side: under}"},
      {"region: side, side: left", "region: side, side: left, radius_m: 1"},
      {"metres_per_unit: 0.001", "metres_per_unit: 0"},
      {"modal_ratios: [0.02, 0.01]", "modal_ratios: []"},
      {"modal_ratios: [0.02, 0.01]", "modal_ratios: [0.02, 0.01], first_ratio: 0.1"},
      {"title: Every key there is\n", ""},
      {"title: Every", "titel: x\ntitle: Every"},
      {"tapstudy/1", "tapstudy/2"},
      {"mass_kg: 0.058", "mass_kg: -1"},
      {"mass_kg: 0.058", "mass_kg: heavy"},
      {"rate_hz: 1000", "rate_hz: 100"},
      {"origin_m: [0, 0, 0]", "origin_m: [0, 0]"},
      {"lateral_scale: 1", "lateral_scale: 0"},
      {"poissons_ratio: 0.25", "poissons_ratio: 0.5"},
      {"poissons_ratio: 0.25", "poissons_ratio: 0.49"},
      {"alpha_per_s: 120, beta_s: 7.05e-5", "alpha_per_s: 120"},
      {"first_ratio: 0.2, last_ratio: 0.1", "first_ratio: 0.2"},
      {"first_ratio: 0.2, last_ratio: 0.1", "first_ratio: 0.2, last_ratio: 0.1, beta_s: 0"},
      {"order: 1", "order: 3"},
      {"region: vertex", "region: blob"},
      {"face: through, radius_m: 0.02", "face: through"},
      {"region: vertex, at_m: [-0.3, -0.3]", "region: vertex, radius_m: 1, at_m: [0.3, 0.3]"},
      {"axes: z", "axes: zz"},
      {"technique: none", "technique: magic"},
      {"factors: {material: mdf}", "factors: {material: [1]}"},
      {"task: identification", "task: guessing"},
      {"stimuli: [a]\n", "stimuli: []\n"},
      {"stimuli: [a, b]}", "stimuli: [a, a]}"},
      {"responses: [a, b]", "respones: [a, b]"},
      {"repetitions: 2", "repetitions: 2.5"},
      {"order: williams", "order: latin"},
      {"practice: true", "practice: maybe"},
      {"claim: chosen_above_chance, stimulus: a", "claim: chosen_above_chance"},
      {"taps_per_visit: 4", "taps_per_visit: 0"},
      {"noise_db: 9", "noise_db: -9"},
      {"simulation:\n  hand: {", "simulation:\n  foot: {}\n  hand: {"},
  }));
  INFO(from << " → " << to);
  const std::string text = testing::replaced(every_key(), from, to);
  CHECK(reader_accepts(text) == schema_accepts(text));
}
