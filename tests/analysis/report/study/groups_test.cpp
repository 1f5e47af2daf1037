#include "analysis/report/study/groups.hpp"

#include <limits>

#include "analysis/report/study/planned_comparisons.hpp"
#include "analysis/statistics/population/independent_groups.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

namespace {
using Blocks = std::vector<std::shared_ptr<const BlockSummary>>;

void add(Blocks& blocks, const std::string& name, const PersonalValues& values) {
  BlockDesign design;
  design.name = name;
  auto block = std::make_shared<BlockSummary>(design);
  block->personal = values;
  blocks.push_back(block);
}

const std::vector<ParticipantGroup> groups{{"trained", {"T1", "T2", "T3"}},
                                           {"untrained", {"U1", "U2", "U3", "U4"}}};
const std::map<std::string, double> shares{{"T1", 0.75}, {"T2", 0.875}, {"T3", 1.0}, {"U1", 0.5},
                                           {"U2", 0.25}, {"U3", 0.375}, {"U4", 0.5}};

double value(const Cell& cell, std::size_t i = 0) {
  const auto* const whole = std::get_if<std::int64_t>(&cell.values[i]);
  return whole != nullptr ? static_cast<double>(*whole) : std::get<double>(cell.values[i]);
}
}  // namespace

TEST_CASE("each group's mean and the groups' difference are of participants' values",
          "[analysis][report][groups]") {
  Blocks blocks;
  add(blocks, "test", {"share", false, shares});
  add(blocks, "training", {"share", false, {{"T1", 0.5}, {"T2", 0.5}, {"T3", 0.75}}});
  const auto section = groups_section(blocks, groups);
  REQUIRE(section);
  const auto& means = section->tables[0].rows;
  REQUIRE(means.size() == 2);  // training was of one group
  CHECK(means[0][2].text == "trained");
  CHECK(value(means[0][4]) == Approx(0.875));
  CHECK(value(means[1][3]) == 4.0);
  const auto& rows = section->tables[1].rows;
  REQUIRE(rows.size() == 1);
  const GroupContrast expected = group_contrast({0.75, 0.875, 1.0}, {0.5, 0.25, 0.375, 0.5}, 1);
  CHECK(value(rows[0][4]) == expected.difference);
  CHECK(value(rows[0][4], 1) == expected.interval->low);
  CHECK(value(rows[0][7]) == expected.test.p);
  CHECK(value(rows[0][7]) == Approx(1.0 / 35.0));  // of all 35 assignments none is as far apart
}

TEST_CASE("contrasts of a measure are adjusted for one another", "[analysis][report][groups]") {
  Blocks blocks;
  add(blocks, "test", {"share", false, shares});
  add(blocks, "retest", {"share", false, shares});
  add(blocks, "other", {"threshold", true, shares});
  const auto section = groups_section(blocks, groups);
  REQUIRE(section);
  REQUIRE(section->tables[1].rows.size() == 2);
  CHECK(value(section->tables[1].rows[0][8]) == Approx(2.0 / 35.0));
  REQUIRE(section->tables[2].rows.size() == 1);
  CHECK(value(section->tables[2].rows[0][8]) == Approx(value(section->tables[2].rows[0][7])));
}

TEST_CASE("who lies beyond the levels is in the test of groups, and no mean is made up",
          "[analysis][report][groups]") {
  Blocks blocks;
  PersonalValues values{"threshold", true, shares};
  values.by_participant.erase("T1");
  values.beyond["T1"] = {1.0, std::numeric_limits<double>::infinity()};
  values.by_participant.erase("U4");
  for (const auto& [participant, share] : shares) {
    values.participants.insert(participant);
  }
  add(blocks, "test", values);
  const auto section = groups_section(blocks, groups);
  REQUIRE(section);
  CHECK(section->tables[0].rows[0][4].text == "–");
  CHECK(section->tables[0].rows[1][3].text == "3 of 4");
  CHECK_THAT(section->findings.at(0),
             Contains("test, trained (3 participants, 1 of them beyond the levels) against "
                      "untrained (3 of 4 participants): by order alone; p = "));
  const auto& rows = section->tables[2].rows;
  REQUIRE(rows.size() == 1);
  CHECK(value(rows[0][5]) == 3.0);
  CHECK(value(rows[0][7]) == Approx(0.1));  // all of one group above all of the other, either way
}

TEST_CASE("a declared contrast of two groups is theirs in the table, in no other's place",
          "[analysis][report][groups]") {
  Blocks blocks;
  add(blocks, "test", {"share", false, shares});
  const std::vector<ParticipantGroup> three{groups[0], {"between", {"U4"}}, groups[1]};
  PlannedComparison planned;
  planned.groups = {"untrained", "trained"};
  const HypothesisResult result = compare_groups(planned, *blocks[0], three);
  const auto section = groups_section(blocks, groups);
  CHECK(result.p == value(section->tables[1].rows[0][7]));
  CHECK_THAT(result.finding, Contains("mean difference 0.469, 95 % CI "));  // .875 - .40625
  CHECK_THAT(result.test, Contains("trained (3 participants) against untrained (4 participants)"));
  planned.groups = {"between", "trained"};
  CHECK_FALSE(compare_groups(planned, *blocks[0], three).p);
}

TEST_CASE("a declared contrast of groups is a hypothesis of its block, and of no part of one",
          "[analysis][report][groups]") {
  BlockDesign test;
  test.name = "test";
  PlannedComparison learned;
  learned.groups = {"trained", "untrained"};
  test.comparisons.push_back(learned);
  StudyDesign design;
  design.blocks = {test};
  design.groups = groups;
  const bool is_part = GENERATE(false, true);
  CAPTURE(is_part);
  BlockDesign reported = test;
  reported.name = is_part ? "test_at_250" : "test";
  reported.part_of = is_part ? "test" : "";
  const auto block = std::make_shared<BlockSummary>(reported);
  block->personal = PersonalValues{"share", false, shares};
  const std::map<std::string, std::vector<results::AnswerRow>> answers{{"test", {{}}}};
  SECTION("tested") {
    add_planned_comparisons(design, answers, {block});
    REQUIRE(block->hypotheses.size() == 1);
    CHECK(block->hypotheses[0].p.has_value() == !is_part);
  }
  SECTION("not without its premise") {
    design.blocks[0].premise = "nobody was trained";
    add_planned_comparisons(design, answers, {block});
    CHECK(block->hypotheses.at(0).test == "nobody was trained");
  }
}

TEST_CASE("groups that were presented stimuli with other right answers are not compared",
          "[analysis][report][groups]") {
  Blocks blocks;
  add(blocks, "test", {"share", false, shares});
  add(blocks, "retest", {"share", false, shares});
  const auto section = groups_section(
      blocks, groups,
      {{"test", "trained", "untrained", false}, {"retest", "trained", "untrained", true}});
  REQUIRE(section);
  CHECK(section->tables[0].rows.size() == 4);  // each mean is one of its own group
  REQUIRE(section->tables[1].rows.size() == 1);
  CHECK(section->tables[1].rows[0][1].text == "retest");
  REQUIRE(section->remarks.size() == 3);
  CHECK_THAT(section->remarks[1].words, Contains("their values are not compared"));
  CHECK_THAT(section->remarks[2].words, Contains("the groups and of the stimuli together"));
}

TEST_CASE("without two groups in a block nothing is compared", "[analysis][report][groups]") {
  Blocks blocks;
  add(blocks, "training", {"share", false, {{"T1", 0.5}, {"T2", 0.5}}});
  CHECK_FALSE(groups_section(blocks, groups));
  CHECK_FALSE(groups_section(blocks, {}));
}
