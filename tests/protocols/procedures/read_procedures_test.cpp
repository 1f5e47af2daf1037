// The JSON schemas of procedures against their readers.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.hpp"
#include "protocols/procedures/likelihood_table.hpp"
#include "support/catch.hpp"
#include "support/procedures.hpp"
#include "support/processes.hpp"
#include "support/schema_keys.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
// A mapping with one key, a procedure.
std::string whole_schema() {
  return protocols::MapReader::schema_of(
      "procedures", "Which stimulus comes next.",
      [](protocols::MapReader& reader) { protocols::read_procedure(reader); });
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
  CHECK(testing::schema_keys(nlohmann::json::parse(whole_schema())) == asked_keys());
}

TEST_CASE("schemas and readers of procedures accept the same", "[protocols][procedures][schema]") {
  const testing::TempDirectory directory;
  testing::write(directory / "schema.json", whole_schema());
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

// Settings with which no procedure could do its work, by line and key.
namespace {
const std::string right_constant = R"(
constant:
  values: [1, 2, 3]
  repetitions: 10
)";
const std::string right_spaced = R"(
constant:
  min: 1
  max: 3
  count: 3
  repetitions: 10
)";
const std::string right_staircase = R"(
staircase:
  rule: transformed
  n_down: 2
  steps: linear
  start: 5
  min: 1
  max: 10
  first_step: 2
  min_step: 0.5
  stop: {reversals: 8}
  estimate_reversals: 6
)";
const std::string right_quest_plus = R"(
quest_plus:
  function: weibull
  stimulus: {min: 0.1, max: 10, count: 21, spacing: log}
  threshold: {min: 0.5, max: 5, count: 11, prior: normal, mean: 2, sd: 1}
  slope: {values: [2, 4]}
  guess: {values: [0.5]}
  lapse: {values: [0.02]}
  further_axes:
    - {values: [0, 1], effect: {values: [-0.1, 0.1], prior: listed, weights: [1, 1]}}
  stop: {trials: 40}
)";
const std::string right_psi = R"(
psi:
  function: logistic
  stimulus: {min: -3, max: 3, count: 21}
  threshold: {min: -2, max: 2, count: 11}
  slope: {values: [2, 4]}
  guess: 0.5
  lapse: 0.02
  stop: {trials: 40}
)";

std::string message_of(const std::string& yaml) {
  try {
    testing::procedure_of(yaml);
  } catch (const core::InvalidInput& error) {
    return error.what();
  }
  return "";
}

struct Spoilt {
  const std::string* base;
  const char* from;
  const char* to;
  int line;
  const char* message;  // its key, and some of its words
};
}  // namespace

TEST_CASE("settings of procedures that make no sense are refused by line and key",
          "[protocols][procedures]") {
  for (const std::string* base :
       {&right_constant, &right_spaced, &right_staircase, &right_quest_plus, &right_psi}) {
    REQUIRE(message_of(*base).empty());
  }
  const auto [base, from, to, line, message] = GENERATE(values<Spoilt>({
      {&right_constant, "[1, 2, 3]", "[1, 3, 2]", 3,
       "constant.values: are not in increasing order"},
      {&right_constant, "[1, 2, 3]", "[]", 3, "constant.values: "},
      {&right_constant, "[1, 2, 3]", "[1, 2, 3]\n  max: 3", 4, "constant.max: is not for values"},
      {&right_constant, "10", "0", 4, "constant.repetitions: "},
      {&right_constant, "10", "10\n  order: listed", 5, "constant.order: "},
      {&right_constant, "constant", "constants", 2, "constants: is not a known key"},
      {&right_spaced, "max: 3", "max: 1", 3, "constant.min: 1 is not below max, 1"},
      {&right_spaced, "count: 3", "count: 1", 5, "constant.count: "},
      {&right_spaced, "min: 1", "min: 0\n  spacing: log", 4,
       "constant.spacing: log needs values above 0, not 0"},
      {&right_spaced, "min: 1\n  max: 3\n  count: 3",
       "min: 1\n  max: 1.0000000000000002\n  count: 100", 5, "constant.count: is too high"},
      {&right_spaced, "count: 3\n  repetitions: 10", "count: 1000\n  repetitions: 101", 6,
       "constant.repetitions: make too many trials"},
      {&right_staircase, "first_step: 2", "first_step: 0", 9,
       "staircase.first_step: 0 is not allowed"},
      {&right_staircase, "first_step: 2", "first_step: 10", 9, "staircase.first_step: leads from"},
      {&right_staircase, "min_step: 0.5", "min_step: 3", 10,
       "staircase.min_step: is above first_step"},
      {&right_staircase, "min_step: 0.5", "min_step: 1e-20", 10, "staircase.min_step: is lost in"},
      {&right_staircase, "max: 10", "max: 1", 8, "staircase.max: is not above min"},
      {&right_staircase, "start: 5", "start: 11", 6, "staircase.start: is not between"},
      {&right_staircase, "start: 5", "start: 1", 6, "staircase.start: is the limit already"},
      {&right_staircase, "start: 5", "start: 10\n  after_correct: increase", 6,
       "staircase.start: is the limit already"},
      {&right_staircase, "steps: linear", "steps: factor", 10,
       "staircase.min_step: is not above 1"},
      {&right_staircase, "steps: linear\n  start: 5\n  min: 1", "steps: db\n  start: 5\n  min: 0",
       7, "staircase.min: is not above 0"},
      {&right_staircase, "min_step: 0.5", "min_step: 0.5\n  n_up: 0", 11, "staircase.n_up: "},
      {&right_staircase, "n_down: 2", "n_down: 0", 4, "staircase.n_down: "},
      {&right_staircase, "n_down: 2", "target: 0.75", 4, "staircase.target: is for rule: weighted"},
      {&right_staircase, "rule: transformed", "rule: weighted", 4,
       "staircase.n_down: is for rule: transformed"},
      {&right_staircase, "rule: transformed\n  n_down: 2", "rule: weighted\n  target: 1", 4,
       "staircase.target: 1 is not allowed"},
      {&right_staircase, "{reversals: 8}", "{}", 11, "staircase.stop: has neither"},
      {&right_staircase, "{reversals: 8}", "{reversals: 4}", 12,
       "staircase.estimate_reversals: is more"},
      {&right_staircase, "{reversals: 8}", "{trials: 4}", 12,
       "staircase.estimate_reversals: is more"},
      {&right_staircase, "estimate_reversals: 6", "estimate_reversals: 5", 12,
       "staircase.estimate_reversals: is odd"},
      {&right_quest_plus, "weibull", "probit", 3, "quest_plus.function: 'probit' is not a known"},
      {&right_quest_plus, "min: 0.1, max: 10, count: 21, spacing: log", "values: [-1, 1]", 4,
       "quest_plus.stimulus: has values below 0"},
      {&right_quest_plus, "min: 0.5, max: 5, count: 11", "values: [0, 1]", 5,
       "quest_plus.threshold: has values from 0 to 1"},
      {&right_quest_plus, "mean: 2, sd: 1", "mean: 2e4, sd: 1", 5,
       "quest_plus.threshold.prior: excludes every value"},
      {&right_quest_plus, "mean: 2, sd: 1", "mean: 2, sd: 0", 5, "quest_plus.threshold.sd: "},
      {&right_quest_plus, "prior: normal, mean: 2", "prior: log_normal, mean: 0", 5,
       "quest_plus.threshold.prior: is log_normal"},
      {&right_quest_plus, "prior: normal, mean: 2, sd: 1", "prior: uniform, mean: 2", 5,
       "quest_plus.threshold.mean: is for prior"},
      {&right_quest_plus, "prior: normal", "prior: normal, weights: [1]", 5,
       "quest_plus.threshold.weights: is for prior"},
      {&right_quest_plus, "weights: [1, 1]", "weights: [0, 0]", 10,
       "quest_plus.further_axes[0].effect.weights: are all 0"},
      {&right_quest_plus, "weights: [1, 1]", "weights: [1]", 10,
       "quest_plus.further_axes[0].effect.weights: are 1, values are 2"},
      {&right_quest_plus, "weights: [1, 1]", "weights: [-1, 1]", 10,
       "quest_plus.further_axes[0].effect.weights[0]: -1 is not allowed"},
      {&right_quest_plus, "slope: {values: [2, 4]}", "slope: {values: [0, 4]}", 6,
       "quest_plus.slope: has values from 0 to 4"},
      {&right_quest_plus, "lapse: {values: [0.02]}", "lapse: {values: [0.02, 0.5]}", 8,
       "quest_plus.lapse: and guess reach 1"},
      {&right_quest_plus, "lapse: {values: [0.02]}", "lapse: {values: [0.02, 1]}", 8,
       "quest_plus.lapse: has values from 0.02 to 1"},
      {&right_quest_plus, "count: 21, spacing: log}\n  threshold: {min: 0.5, max: 5, count: 11",
       "count: 500}\n  threshold: {min: 0.5, max: 5, count: 1000", 3,
       "quest_plus: the grids make 8000000 likelihoods"},
      {&right_quest_plus, "trials: 40", "trials: 0", 11, "quest_plus.stop.trials: "},
      {&right_quest_plus, "trials: 40", "trials: 40, threshold_sd: 2", 3,
       "quest_plus: the prior's standard deviation of threshold"},
      {&right_psi, "guess: 0.5", "guess: 1", 7, "psi.guess: 1 is not allowed"},
      {&right_psi, "guess: 0.5", "guess: {values: [0.5]}", 7,
       "psi.guess: a mapping is not a number"},
      {&right_psi, "trials: 40", "trials: 40, threshold_sd: 1", 9,
       "psi.stop.threshold_sd: is not a known"},
      {&right_psi, "min: -2, max: 2, count: 11}\n  slope: {values: [2, 4]}",
       "values: [1]}\n  slope: {values: [2]}", 3, "psi: there is nothing to estimate"},
      {&right_psi, "[2, 4]}\n  guess: 0.5\n  lapse: 0.02", "[1e4]}\n  guess: 0\n  lapse: 0", 3,
       "psi: an answer could exclude every combination"},
  }));
  INFO(from << " -> " << to);
  const std::string found = message_of(testing::replaced(*base, from, to));
  CHECK_THAT(found, Contains(fmt::format("p.yaml:{}:", line)) && Contains(message));
}

TEST_CASE("a table refuses models and priors that are none", "[protocols][procedures]") {
  using protocols::LikelihoodTable;
  protocols::QuestPlusDesign good;
  good.axes = {{0.0, 1.0}};
  good.parameters = {{"p", {0.2, 0.8}, {1.0, 1.0}}};
  good.model = [](auto /*stimulus*/, auto parameters, auto probabilities) {
    probabilities[0] = 1.0 - parameters[0];
    probabilities[1] = parameters[0];
  };
  REQUIRE_NOTHROW(LikelihoodTable{good});
  const auto refused = [&](const std::function<void(protocols::QuestPlusDesign&)>& change) {
    protocols::QuestPlusDesign bad = good;
    change(bad);
    CHECK_THROWS_AS(LikelihoodTable{bad}, core::InvalidInput);
  };
  refused([](auto& bad) { bad.parameters[0].weights = {0.0, 0.0}; });
  refused([](auto& bad) { bad.parameters[0].weights = {-1.0, 2.0}; });
  refused([](auto& bad) { bad.parameters[0].weights = {1.0}; });
  refused([](auto& bad) { bad.parameters[0].is_nuisance = true; });
  refused([](auto& bad) { bad.axes.clear(); });
  refused([](auto& bad) { bad.axes.push_back({}); });
  refused([](auto& bad) { bad.outcomes = 1; });
  refused([](auto& bad) { bad.model = [](auto, auto, auto each) { each[0] = each[1] = 0.6; }; });
  refused([](auto& bad) { bad.parameters[0].values = {-0.5, 1.5}; });
}
