// The JSON schemas of procedures against their readers.
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/procedures.hpp"
#include "support/processes.hpp"
#include "support/schema_keys.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
// A mapping with one key, a procedure.
nlohmann::json whole_schema() {
  nlohmann::json schema{{"title", "tapstudy procedures"},
                        {"description", "Which stimulus comes next."},
                        {"type", "object"},
                        {"additionalProperties", false}};
  for (const protocols::Procedure* procedure : protocols::procedures()) {
    const std::string name{procedure->name()};
    schema["properties"][name] = nlohmann::json::parse(
        testing::contents(testing::shipped("schema/procedures/" + name + ".json")));
    schema["oneOf"].push_back({{"required", {name}}});
  }
  return schema;
}

// With every key, in both forms where there are two.
const std::vector<std::string> every_key{
    "constant: {values: [1, 2], repetitions: 3, order: shuffle}",
    "constant: {min: 1, max: 4, count: 3, spacing: log, repetitions: 3}",
    "staircase: {rule: transformed, n_down: 2, n_up: 1, after_correct: decrease, steps: db, "
    "first_step: 6, min_step: 1.5, start: 10, min: 0.1, max: 100, stop: {reversals: 10, trials: "
    "80}, estimate_reversals: 6}",
    "staircase: {rule: weighted, target: 0.75, steps: linear, first_step: 2, start: 10, min: 0, "
    "max: 20, stop: {trials: 80}, estimate_reversals: 6}",
    "quest_plus: {function: weibull, stimulus: {min: 0.1, max: 10, count: 5, spacing: log}, "
    "threshold: {min: 0.5, max: 2, count: 3, spacing: linear, prior: log_normal, mean: 1, sd: "
    "0.5}, slope: {values: [2, 3]}, guess: {values: [0.5], prior: listed, weights: [1]}, lapse: "
    "{values: [0, 0.02], nuisance: true}, further_axes: [{values: [0, 1], effect: {values: [0, "
    "0.1]}}], stop: {trials: 30, threshold_sd: 0.2}}",
    "psi: {function: logistic, stimulus: {values: [-1, 0, 1]}, threshold: {values: [-1, 1], prior: "
    "normal, mean: 0, sd: 1}, slope: {values: [1, 2], prior: listed, weights: [1, 2]}, guess: "
    "0.5, lapse: 0.02, stop: {trials: 30}}"};

// Each parameter and axis once listed and once spaced, with each prior.
std::set<std::string> asked_keys() {
  protocols::Problems problems{"p.yaml"};
  const auto read = [&](const std::string& yaml) {
    auto reader = protocols::MapReader::whole_file(yaml, "p.yaml", problems);
    protocols::read_procedure(reader);
  };
  for (const std::string& yaml : every_key) {
    read(yaml);
  }
  const std::string spaced = "{min: 1, max: 2, count: 2, prior: normal, mean: 1, sd: 1}";
  const std::string listed = "{values: [1, 2], prior: listed, weights: [1, 1]}";
  for (const std::string& grid : {spaced, listed}) {
    const std::string axis = grid == spaced ? "min: 1, max: 2, count: 2" : "values: [1, 2]";
    const std::string start =
        "function: gumbel, stimulus: {" + axis + "}, threshold: " + grid + ", slope: " + grid;
    read("psi: {" + start + ", guess: 0, lapse: 0.1, stop: {trials: 1}}");
    read("quest_plus: {" + start + ", guess: " + grid + ", lapse: " + grid + ", further_axes: [{" +
         axis + ", effect: " + grid + "}], stop: {trials: 1}}");
  }
  return problems.asked();
}

bool reader_accepts(const std::string& yaml) {
  try {
    testing::procedure_of(yaml);
  } catch (const core::InvalidInput&) {
    return false;
  }
  return true;
}

struct Change {
  std::size_t base;
  const char* from;
  const char* to;
};
const std::vector<Change> changes{
    {0, "[1, 2]", "[]"},
    {0, "[1, 2]", "[1, 1]"},
    {0, "[1, 2]", "[1, 2], min: 1"},
    {0, "repetitions: 3", "repetitions: 0"},
    {0, "order: shuffle", "order: listed"},
    {0, "constant", "constants"},
    {1, "count: 3", "count: 1"},
    {1, "count: 3, ", ""},
    {1, "spacing: log", "spacing: ln"},
    {2, "n_down: 2, ", ""},
    {2, "n_down: 2", "n_down: 11"},
    {2, "n_up: 1", "target: 0.7"},
    {2, "after_correct: decrease", "after_correct: none"},
    {2, "steps: db", "steps: factor"},
    {2, "first_step: 6", "first_step: 0"},
    {2, ", min_step: 1.5", ""},
    {2, "start: 10, ", ""},
    {2, "{reversals: 10, trials: 80}", "{}"},
    {2, ", trials: 80", ""},
    {2, "trials: 80", "trials: 1001"},
    {2, "estimate_reversals: 6", "estimate_reversals: 5"},
    {2, ", estimate_reversals: 6", ""},
    {3, "target: 0.75", "n_down: 2"},
    {3, "target: 0.75", "target: 0.99"},
    {3, "rule: weighted", "rule: weighted, n_up: 1"},
    {4, "weibull", "probit"},
    {4, "sd: 0.5", "sd: 0"},
    {4, ", sd: 0.5", ""},
    {4, "prior: log_normal", "prior: uniform"},
    {4, "weights: [1]", "weights: [-1]"},
    {4, ", weights: [1]", ""},
    {4, "slope: {values: [2, 3]}", "slope: {values: [0, 3]}"},
    {4, "slope: {values: [2, 3]}", "slope: {min: 0, max: 3, count: 2}"},
    {4, "[0, 0.02]", "[0, 1]"},
    {4, "nuisance: true", "nuisance: yes please"},
    {4, ", effect: {values: [0, 0.1]}", ""},
    {4, "threshold_sd: 0.2", "threshold_sd: 0"},
    {4, ", threshold_sd: 0.2", ""},
    {5, "guess: 0.5", "guess: 1"},
    {5, "guess: 0.5", "guess: {values: [0.5]}"},
    {5, "trials: 30", "trials: 30, threshold_sd: 0.2"},
    {5, "{trials: 30}", "{}"},
};
}  // namespace

TEST_CASE("the schemas of procedures have exactly the keys that their readers ask for",
          "[protocols][procedures][schema]") {
  CHECK(testing::schema_keys(whole_schema()) == asked_keys());
}

TEST_CASE("schemas and readers of procedures accept the same", "[protocols][procedures][schema]") {
  const testing::TempDirectory directory;
  testing::write(directory / "schema.json", whole_schema().dump());
  std::vector<std::string> texts = every_key;
  for (const auto& [base, from, to] : changes) {
    texts.push_back(testing::replaced(every_key[base], from, to));
  }
  texts.push_back("constant: {values: [1], repetitions: 1}\n" + every_key[5]);
  std::vector<std::string> command{"/usr/bin/python3",
                                   testing::source("tests/protocols/validate.py"),
                                   directory / "schema.json"};
  for (const std::string& text : texts) {
    command.push_back(directory / (std::to_string(command.size()) + ".yaml"));
    testing::write(command.back(), text);
  }
  const auto run = testing::run_program(command);
  INFO(run.standard_error);
  std::istringstream verdicts{run.standard_output};
  for (const std::string& text : texts) {
    std::string verdict;
    REQUIRE(verdicts >> verdict);
    INFO(text);
    CHECK((verdict == "fits") == reader_accepts(text));
  }
  for (const std::string& text : every_key) {
    CHECK(reader_accepts(text));
  }
}

TEST_CASE("the reference of keys can be written from the schemas of procedures",
          "[protocols][procedures][schema]") {
  const testing::TempDirectory directory;
  testing::write(directory / "schema.json", whole_schema().dump());
  const auto run = testing::run_program(
      {"/usr/bin/python3", "-c",
       "import json, sys; sys.path.insert(0, sys.argv[1]); import write_readme\n"
       "schema = json.load(open(sys.argv[2]))\n"
       "write_readme.nested('', schema, '')\n"
       "sys.exit('\\n'.join(write_readme.gaps('', schema)) or 0)",
       testing::shipped("schema").string(), directory / "schema.json"});
  INFO(run.standard_error);
  CHECK(run.exit_code == 0);
}
