// What discrimination tasks present, and which answers are right.
#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "core/error.hpp"
#include "protocols/protocol.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "protocols/schedule/schedule.hpp"
#include "protocols/tasks/answers.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
// What answers are read from, at the terminal and from pages alike.
using namespace tapstudy;
using protocols::answer_in;
using protocols::AnswerKind;
using protocols::Answers;

TEST_CASE("a magnitude is a number above 0 in decimal notation, and nothing else is",
          "[protocols][tasks]") {
  const Answers numbers{AnswerKind::number};
  const std::map<std::string, double> read{{"12", 12.0},  {" 0.5 ", 0.5}, {"007", 7.0},
                                           {".25", 0.25}, {"3.", 3.0},    {"1000000", 1e6},
                                           {"2.50", 2.5}};
  for (const auto& [text, number] : read) {
    CAPTURE(text);
    REQUIRE(answer_in(text, numbers));
    CHECK(std::stod(*answer_in(text, numbers)) == number);
  }
  for (const char* const text : {"",
                                 " ",
                                 "0",
                                 "0.0",
                                 "-3",
                                 "+3",
                                 "nan",
                                 "NaN",
                                 "inf",
                                 "infinity",
                                 "1e3",
                                 "0x10",
                                 "twelve",
                                 "1,500",
                                 "1 2",
                                 "1/2",
                                 "1.2.3",
                                 ".",
                                 "12 cm",
                                 "\u0661",
                                 "100000000000000000000",
                                 "0.0000000000000000001"}) {
    CAPTURE(text);
    CHECK_FALSE(answer_in(text, numbers));
  }
  CHECK_FALSE(answer_in(std::string(100'000, '9'), numbers));
}

TEST_CASE("the same magnitude is stored as the same text, however it was written",
          "[protocols][tasks]") {
  const Answers numbers{AnswerKind::number};
  CHECK(answer_in("2.50", numbers) == answer_in(" 02.5", numbers));
}

TEST_CASE("an option is read from its place and told by its label", "[protocols][tasks]") {
  const Answers answers{AnswerKind::option, {{"mdf", "wood fibre"}, {"acrylic", "acrylic"}}};
  CHECK(answer_in("1", answers) == "mdf");
  CHECK(answer_in(" 2 ", answers) == "acrylic");
  CHECK(label_of_answer("mdf", answers) == "wood fibre");
  for (const char* const text : {"", "0", "3", "-1", "1.0", "mdf", "18446744073709551617"}) {
    CAPTURE(text);
    CHECK_FALSE(answer_in(text, answers));
  }
}

TEST_CASE("an order names every option once, by its place", "[protocols][tasks]") {
  const Answers answers{AnswerKind::order, {{"A", "A"}, {"B", "B"}, {"C", "sea"}}};
  CHECK(answer_in("3 1 2", answers) == "C A B");
  CHECK(answer_in(" 3,1, 2 ", answers) == "C A B");
  CHECK(label_of_answer("C A B", answers) == "sea A B");
  for (const char* const text : {"", "1", "1 2", "1 2 2", "1 2 4", "1 2 3 1", "123", "A B C"}) {
    CAPTURE(text);
    CHECK_FALSE(answer_in(text, answers));
  }
}

TEST_CASE("a setting is answered by its place, and nothing else is one", "[protocols][tasks]") {
  Answers answers{AnswerKind::setting};
  answers.settings = 12;
  CHECK(answer_in("1", answers) == "1");
  CHECK(answer_in(" 012 ", answers) == "12");
  for (const char* const text : {"", "0", "13", "-1", "+1", "1.5", "=", "A"}) {
    CAPTURE(text);
    CHECK_FALSE(answer_in(text, answers));
  }
  CHECK(protocols::expected_answer(answers) == "a number from 1 to 12");
}

TEST_CASE("a mark on a line is a number from 0 to 1, and nothing else is one",
          "[protocols][tasks]") {
  Answers answers{AnswerKind::line};
  answers.ends = {"soft", "hard"};
  CHECK(answer_in("0", answers) == "0");
  CHECK(answer_in(" .370 ", answers) == "0.37");
  CHECK(answer_in("1.0", answers) == "1");
  for (const char* const text : {"", "1.01", "-0.1", "+0.1", "1e-1", "nan", "0.5 0.6", "soft"}) {
    CAPTURE(text);
    CHECK_FALSE(answer_in(text, answers));
  }
  CHECK(protocols::expected_answer(answers) == "a number from 0 (soft) to 1 (hard)");
}

namespace {
protocols::Protocol every_task() {
  return protocols::read_protocol(testing::source("tests/data/same_alternatives.yaml"));
}
std::string layout_of(const protocols::PlannedTrial& trial) {
  std::string layout;
  for (const protocols::Alternative& alternative : trial.alternatives) {
    layout += alternative.is_comparison ? 'C' : 'S';
  }
  return layout;
}
}  // namespace

TEST_CASE("each way to arrange standard and comparison is presented equally often",
          "[protocols][tasks]") {
  const protocols::Protocol protocol = every_task();
  const std::map<std::string, std::set<std::string>> ways{
      {"comparison", {"CS", "SC"}},
      {"same_different", {"SS", "CC", "SC", "CS"}},
      {"odd_one_out", {"CSS", "SCS", "SSC", "SCC", "CSC", "CCS"}},
      {"abx", {"SCS", "SCC", "CSS", "CSC"}}};
  std::map<std::string, std::map<std::string, int>> seen;
  for (const protocols::PlannedTrial& trial : make_schedule(protocol, 7, 0)) {
    ++seen[trial.block][layout_of(trial)];
  }
  for (const auto& [block, expected] : ways) {
    CAPTURE(block);
    CHECK(seen[block].size() == expected.size());
    for (const auto& [layout, count] : seen[block]) {
      CHECK(expected.contains(layout));
      CHECK(count == 240 / static_cast<int>(expected.size()));
    }
  }
}

TEST_CASE("exactly one answer is right where one is, and it names what differs",
          "[protocols][tasks]") {
  const protocols::Protocol protocol = every_task();
  const auto right_of = [&](const protocols::PlannedTrial& trial) {
    const protocols::Block& block = protocol.block(trial.block);
    std::vector<std::string> right;
    for (const protocols::Option& option : trial.task->answers(block, protocol).options) {
      const std::string response = trial.task->response(trial, block, option.name);
      if (trial.task->is_correct(trial, block, response).value_or(false)) {
        right.push_back(response);
      }
    }
    return right;
  };
  const std::map<std::string, std::map<std::string, std::string>> expected{
      {"comparison", {{"CS", "A"}, {"SC", "B"}}},
      {"same_different",
       {{"SS", "same"}, {"CC", "same"}, {"SC", "different"}, {"CS", "different"}}},
      {"odd_one_out",
       {{"CSS", "A"}, {"SCS", "B"}, {"SSC", "C"}, {"SCC", "A"}, {"CSC", "B"}, {"CCS", "C"}}},
      {"abx", {{"SCS", "A"}, {"SCC", "B"}, {"CSS", "B"}, {"CSC", "A"}}},
      {"match_to_sample", {{"CSSC", "A"}, {"SCSC", "B"}, {"SSCC", "C"}}}};
  for (const protocols::PlannedTrial& trial : make_schedule(protocol, 3, 0)) {
    CAPTURE(trial.block, layout_of(trial));
    if (expected.contains(trial.block)) {
      CHECK(right_of(trial) == std::vector{expected.at(trial.block).at(layout_of(trial))});
    } else {
      CHECK(right_of(trial).empty());
    }
  }
}

TEST_CASE(
    "intervals that leave no time for an answer, or cannot be drawn, are refused where they are",
    "[protocols][tasks]") {
  const auto refusal = [](const std::string& block, const std::string& other) -> std::string {
    std::string text = testing::contents(testing::source("tests/data/every_task.yaml"));
    const auto at = text.find("  - {name: " + block + ",");
    text.replace(at, text.find('\n', at) - at, "  - {name: " + block + ", " + other + "}");
    try {
      protocols::parse_protocol(text, "study.yaml");
    } catch (const core::InvalidInput& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string pair = "task: paired, question: \"Which?\", stimuli: [one, other], explore: ";
  CHECK_THAT(
      refusal("paired", pair + "{max_seconds: 5, intervals: {seconds: 2, gap_seconds: 0.5}}"),
      Contains("explore: max_seconds: is over before an answer is possible: the intervals "
               "take 5 s"));
  CHECK(refusal("paired", pair + "{max_seconds: 6, intervals: {seconds: 2, gap_seconds: 0.5}}") ==
        "accepted");
  CHECK_THAT(refusal("paired",
                     "task: identification, question: \"Which?\", stimuli: [one], order: williams, "
                     "explore: {intervals: {seconds: 2}}"),
             Contains("order: a Williams order needs at least two stimuli"));
  CHECK_THAT(
      refusal("adjustment",
              "task: adjustment, question: \"Equal?\", stimuli: [one], settings: {from: 1.0e-310, "
              "to: 6, count: 3}, explore: {intervals: {seconds: 2}}"),
      Contains("must have `vary`"));
}

TEST_CASE("every stimulus is the sample equally often with its match at every place",
          "[protocols][tasks]") {
  const protocols::Protocol protocol = every_task();
  std::map<std::pair<std::string, std::string>, int> seen;
  for (const protocols::PlannedTrial& trial : make_schedule(protocol, 7, 0)) {
    if (trial.block == "match_to_sample") {
      std::set<std::string> stimuli;
      for (std::size_t i = 0; i + 1 < trial.alternatives.size(); ++i) {
        stimuli.insert(trial.alternatives[i].stimulus);
        CHECK((trial.alternatives[i].stimulus == trial.alternatives.back().stimulus) ==
              trial.alternatives[i].is_comparison);
      }
      CHECK(stimuli == std::set<std::string>{"one", "other", "third"});
      ++seen[{trial.alternatives.back().stimulus, layout_of(trial)}];
    }
  }
  CHECK(seen.size() == 9);
  for (const auto& [sample, count] : seen) {
    CHECK(count == 25);
  }
}

TEST_CASE("only trials that present a comparison beside a standard tell a procedure anything",
          "[protocols][tasks]") {
  const protocols::Protocol protocol = every_task();
  for (const protocols::PlannedTrial& trial : make_schedule(protocol, 3, 0)) {
    const protocols::Block& block = protocol.block(trial.block);
    const std::string layout = layout_of(trial);
    if (trial.block == "same_different") {
      const auto outcome = trial.task->outcome(trial, block, "different");
      CHECK(outcome ==
            (layout == "SC" || layout == "CS" ? std::optional<std::size_t>{1} : std::nullopt));
    }
  }
}

TEST_CASE("on either side the greater one is right, and procedures hear what was judged greater",
          "[protocols][tasks]") {
  const protocols::Protocol protocol =
      protocols::read_protocol(testing::source("protocols/examples/stiffness_equality.yaml"));
  const protocols::Block& block = protocol.blocks.front();
  CHECK(block.task->statistic(block) == "equality");
  protocols::PlannedTrial trial = make_schedule(protocol, 3, 0).front();
  const bool is_first = trial.alternatives[0].is_comparison;
  const std::string comparison = is_first ? "A" : "B";
  const std::string standard = is_first ? "B" : "A";
  for (const double level : {-0.4, 0.0, 0.66}) {
    CAPTURE(level);
    trial.alternatives[is_first ? 0 : 1].values = {
        {block.comparison->axis, block.comparison->value_at(level)}};
    const auto right = [&](const std::string& answer) {
      return block.task->is_correct(trial, block, answer);
    };
    CHECK(right(comparison) == (level == 0.0 ? std::nullopt : std::optional{level > 0.0}));
    CHECK(right(standard) == (level == 0.0 ? std::nullopt : std::optional{level < 0.0}));
    CHECK(block.task->outcome(trial, block, comparison) == 1);
    CHECK(block.task->outcome(trial, block, standard) == 0);
  }
}

TEST_CASE("comparisons on either side are of two alternatives, and of the task comparison alone",
          "[protocols][tasks]") {
  const std::string text =
      testing::contents(testing::source("protocols/examples/stiffness_equality.yaml"));
  const testing::TempDirectory directory;
  const auto said = [&](const std::string& from, const std::string& to) {
    testing::write(directory / "study.yaml", testing::replaced(text, from, to));
    try {
      protocols::read_protocol(directory / "study.yaml");
    } catch (const std::exception& error) {
      return std::string{error.what()};
    }
    return std::string{};
  };
  CHECK_THAT(said("comparison: either", "comparison: above"),
             Contains("levels are at least 0 (or comparison: either)"));
  CHECK_THAT(said("comparison: either", "comparison: either\n    alternatives: 3"),
             Contains("alternatives") && Contains("are two"));
  CHECK_THAT(said("task: comparison", "task: abx"), Contains("one side of the standard"));
  CHECK_THAT(said("[-0.5,", "[-0.9, -0.5,"), Contains("may ask for the level -0.9"));
}

TEST_CASE(
    "a procedure gets as many trials of different alternatives as it asks for, whatever the "
    "order",
    "[protocols][tasks]") {
  const std::string example = testing::contents(testing::shipped("examples/stiffness_jnd.yaml"));
  const protocols::Protocol protocol = protocols::parse_protocol(
      testing::replaced(testing::replaced(example, "task: comparison", "task: same_different"),
                        "trials: 40", "trials: 42"),
      "study.yaml");
  const protocols::Block* const block = &protocol.blocks.back();
  std::size_t wanted = 0;
  for (const auto& track : block->comparison->tracks) {
    wanted += track->max_trials();
  }
  REQUIRE(wanted % 8 != 0);  // no whole number of runs
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const auto trials = block->task->trials(*block, protocols::Draw{seed});
    CHECK(std::ranges::count_if(trials, [](const protocols::PlannedTrial& trial) {
            return layout_of(trial) == "SC" || layout_of(trial) == "CS";
          }) >= static_cast<std::ptrdiff_t>(wanted));
  }
}

// The standard of a comparison.
namespace {
// The example, with a table of thicknesses instead of Young's modulus.
protocols::Protocol tabled(const std::string& thicknesses, const std::string& standard) {
  std::string text = testing::contents(testing::shipped("examples/stiffness_jnd.yaml"));
  text = testing::replaced(text, "youngs_modulus_pa: {from: 3.2e9, to: 12.8e9, spacing: log}",
                           "thickness_m: " + thicknesses);
  text = testing::replaced(text, "    standard: 3.2e9\n", standard);
  return protocols::parse_protocol(text, "study.yaml");
}
std::string refusal_of_standard(const std::string& thicknesses, const std::string& standard) {
  try {
    tabled(thicknesses, standard);
  } catch (const core::InvalidInput& error) {
    return error.what();
  }
  return "";
}
}  // namespace

TEST_CASE("a standard that is not built is refused, for another plate would be presented",
          "[protocols][tasks]") {
  const std::string table = "{from: 0.05, to: 0.3, count: 51, spacing: linear}";
  CHECK(refusal_of_standard(table, "").empty());  // the plate's own 0.05 m
  CHECK(tabled(table, "    standard: 0.06\n").blocks.front().comparison->standard == 0.06);
  CHECK_THAT(refusal_of_standard(table, "    standard: 0.0624\n"),
             Contains("standard: 0.0624 is not among the values of thickness_m that are built "
                      "(the nearest is 0.06)"));
  CHECK_THAT(refusal_of_standard("{from: 0.04, to: 0.3, count: 11, spacing: linear}", ""),
             Contains("blocks[0].standard: 0.05 is not among"));
}

TEST_CASE("a block without procedures, where they are named, is refused", "[protocols][tasks]") {
  std::string text = testing::contents(testing::shipped("examples/stiffness_jnd.yaml"));
  text = testing::replaced(text.substr(0, text.find("    procedures:")), "    task: comparison\n",
                           "    task: comparison\n    procedures: []\n");
  CHECK_THROWS_WITH(protocols::parse_protocol(text, "study.yaml"),
                    Contains("procedures: is empty (at least one)"));
}

namespace {
std::string example() {
  return testing::contents(testing::shipped("examples/stiffness_jnd_by_damping.yaml"));
}

std::string refusal_of(const std::string& from, const std::string& to) {
  try {
    protocols::parse_protocol(testing::replaced(example(), from, to), "study.yaml");
  } catch (const core::InvalidInput& error) {
    return error.what();
  }
  return "";
}
}  // namespace

TEST_CASE("a procedure varies as many axes as its block names, which its stimulus must have",
          "[protocols][tasks]") {
  const protocols::Protocol protocol = protocols::parse_protocol(example(), "study.yaml");
  const protocols::Comparison& comparison = *protocol.blocks.front().comparison;
  CHECK(comparison.axis == "youngs_modulus_pa");
  CHECK(comparison.further_axes == std::vector<std::string>{"damping_scale"});
  CHECK(comparison.tracks.front()->axes() == 2);

  CHECK_THAT(refusal_of("    further_axes: [damping_scale]\n", ""),
             Contains("procedures[0]: varies 2 axes") && Contains("the block has 1"));
  CHECK_THAT(refusal_of("[damping_scale]", "[youngs_modulus_pa]"),
             Contains("blocks[0].further_axes") && Contains("youngs_modulus_pa"));
  CHECK_THAT(refusal_of("[damping_scale]", "[thickness_m]"), Contains("blocks[0].further_axes"));
  CHECK_THAT(refusal_of("[damping_scale]", "[damping_scale, damping_scale]"),
             Contains("is listed twice"));
  CHECK_THAT(refusal_of("[damping_scale]", "[]"), Contains("blocks[0].further_axes"));
  CHECK_THAT(refusal_of("values: [0.5, 1, 2, 4]", "values: [0.5, 1, 2, 5]"),
             Contains("further_axes[0]") && Contains("damping_scale"));
  CHECK_THAT(refusal_of("- quest_plus:",
                        "- constant: {values: [0.1], repetitions: 2}\n"
                        "      - quest_plus:"),
             Contains("procedures[0]: varies 1 axes") && Contains("the block has 2"));
}

// How runs of the method of adjustment are planned, and what is refused.
namespace {
std::string with_block(const std::string& keys, int repetitions = 12) {
  std::string text = testing::contents(testing::source("tests/data/every_task.yaml"));
  const auto first = text.find("blocks:");
  text.replace(first, text.find("simulation:") - first,
               "blocks:\n  - name: adjustment\n    task: adjustment\n    question: Equal?\n"
               "    repetitions: " +
                   std::to_string(repetitions) + "\n" + keys);
  return testing::replaced(text, ", reference: one}", "}");
}
const std::string family = "    stimuli: [family]\n";
const std::string grid = "    settings: {from: 3, to: 6, count: 7}\n";

std::vector<double> starts_of(const std::string& text, std::uint64_t seed) {
  const protocols::Protocol protocol = protocols::parse_protocol(text, "study.yaml");
  std::vector<double> starts;
  for (const protocols::PlannedTrial& trial : make_schedule(protocol, seed, 0)) {
    starts.push_back(trial.alternatives.back().values.at("sinusoid_amplitude_n_s_per_m"));
  }
  return starts;
}
}  // namespace

TEST_CASE("half of the runs start below the standard and half above, never at it",
          "[protocols][tasks]") {
  for (const char* const standard : {"    standard: 4.5\n", "    standard: 3.2\n",
                                     "    standard: 5.9\n", "    reference: one\n"}) {
    const std::string text = with_block(family + grid + standard);
    const double middle = std::string{standard}.find("reference") == std::string::npos
                              ? std::stod(std::string{standard}.substr(14))
                              : 4.5;
    std::set<std::vector<double>> orders;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const auto starts = starts_of(text, seed);
      CAPTURE(standard, seed);
      CHECK(starts.size() == 12);
      CHECK(std::ranges::count_if(starts, [&](double start) { return start < middle; }) == 6);
      CHECK(std::ranges::count_if(starts, [&](double start) { return start > middle; }) == 6);
      orders.insert(starts);
    }
    CHECK(orders.size() > 1);
    CHECK(starts_of(text, 3) == starts_of(text, 3));
  }
}

TEST_CASE("an odd run starts on either side, and all runs on one where there is no other",
          "[protocols][tasks]") {
  std::set<std::ptrdiff_t> below;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto odd = starts_of(with_block(family + grid + "    standard: 4.5\n", 3), seed);
    below.insert(std::ranges::count_if(odd, [](double start) { return start < 4.5; }));
    const auto low = starts_of(with_block(family + grid + "    standard: 3\n"), seed);
    CHECK(std::ranges::all_of(low, [](double start) { return start > 3.0; }));
    const auto high = starts_of(with_block(family + grid + "    standard: 6\n"), seed);
    CHECK(std::ranges::all_of(high, [](double start) { return start < 6.0; }));
  }
  CHECK(below == std::set<std::ptrdiff_t>{1, 2});
}

TEST_CASE("runs over ratios start below and above the geometric middle", "[protocols][tasks]") {
  const auto starts =
      starts_of(with_block(family + "    settings: {from: 3, to: 6, count: 20, spacing: log}\n"
                                    "    reference: one\n"),
                3);
  CHECK(std::ranges::count_if(starts, [](double start) { return start * start < 18.0; }) == 6);
}

TEST_CASE("what cannot be adjusted is refused once, at its line", "[protocols][tasks]") {
  const auto [keys, key, said] = GENERATE(table<std::string, std::string, std::string>({
      {family, "settings", "is missing"},
      {family + "    settings: {from: 3, to: 6, count: 1}\n", "settings.count", "from 2 to 100"},
      {family + "    settings: {from: 3, to: 6, count: 101}\n", "settings.count", "from 2 to 100"},
      {family + "    settings: {from: 6, to: 3, count: 5}\n", "settings.from", "is not below to"},
      {family + "    settings: {from: 3, to: 3, count: 5}\n", "settings.from", "is not below to"},
      {family + "    settings: {from: -1, to: 3, count: 5, spacing: log}\n", "settings.spacing",
       "log needs values above 0"},
      {family + "    settings: {from: 1, to: 6, count: 5}\n", "settings", "1 is not allowed"},
      {family + "    settings: {from: 4, to: 6, count: 5}\n", "settings",
       "do not include it: the standard, 3,"},
      {family + "    settings: {from: 4, to: 6, count: 5}\n    standard: 3.5\n", "standard",
       "is not within the settings, 4 to 6"},
      {family + grid + "    standard: 7\n", "standard", "7 is not allowed"},
      {family + grid + "    axis: thickness_m\n", "axis", "is not a known axis"},
      {family + grid + "    reference: one\n    standard: 4\n", "standard", "not with a reference"},
      {family + grid + "    reference: nothing\n", "reference", "is not a known stimulus"},
      {family + grid + "    reference: family\n", "reference", "is the stimulus that is adjusted"},
      {"    stimuli: [one]\n" + grid, "stimuli", "which must have `vary`"},
      {"    stimuli: [one]\n" + grid + "    axis: thickness_m\n    standard: 4\n", "stimuli",
       "which must have `vary`"},
      {"    stimuli: [family, one]\n" + grid, "stimuli", "an adjustment moves one stimulus"},
      {family + grid + "    correction: true\n", "correction", "not of a setting"},
      {family + grid + "    order: listed\n", "order", "takes no order"},
      {family + grid + "    presented: real\n", "presented", "several alternatives"},
      {family + grid + "    alternatives: 2\n", "alternatives", "is not a known key"},
  }));
  CAPTURE(keys);
  try {
    protocols::parse_protocol(with_block(keys), "study.yaml");
    FAIL("is taken");
  } catch (const core::InvalidInput& error) {
    const std::string what = error.what();
    CAPTURE(what);
    CHECK_THAT(what, Contains("blocks[0]." + key + ":") && Contains(said));
    CHECK(std::ranges::count(what, '\n') <= 1);
    CHECK(what.find("study.yaml:") == what.rfind("study.yaml:"));
  }
}

TEST_CASE("an axis that the technique does not use is refused once", "[protocols][tasks]") {
  std::string text = with_block(family + "    settings: {from: 1e9, to: 3e9, count: 5}\n");
  text = testing::replaced(text, "{sinusoid_amplitude_n_s_per_m: {from: 3, to: 6}}",
                           "{youngs_modulus_pa: {from: 1e9, to: 3e9}}");
  try {
    protocols::parse_protocol(text, "study.yaml");
    FAIL("is taken");
  } catch (const core::InvalidInput& error) {
    const std::string what = error.what();
    CAPTURE(what);
    CHECK_THAT(what, Contains("vary.youngs_modulus_pa"));
    CHECK(what.find("study.yaml:") == what.rfind("study.yaml:"));
  }
}
