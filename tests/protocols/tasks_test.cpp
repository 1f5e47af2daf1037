// What discrimination tasks present, and which answers are right.
#include <map>
#include <set>

#include "core/error.hpp"
#include "protocols/read_protocol.hpp"
#include "protocols/schedule.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

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
