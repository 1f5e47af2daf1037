#include "analysis/report/study/planned_comparisons.hpp"

#include <cmath>
#include <limits>

#include "analysis/report/summary.hpp"
#include "analysis/statistics/population/planned_contrasts.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

namespace {
// Four stimuli, two factors; a rating of each by each participant: `ratings[person]` in their
// order.
BlockDesign rated_design() {
  BlockDesign design;
  design.name = "rated";
  design.task = "rating";
  design.statistic = "ratings";
  design.steps = 9;
  for (const char* const material : {"mdf", "acrylic"}) {
    for (const char* const structure : {"two", "three"}) {
      const std::string name = std::string{material} + "_" + structure;
      design.stimuli.push_back({name, name, {{"material", material}, {"structure", structure}}});
    }
  }
  return design;
}

std::vector<results::AnswerRow> answers_of(const BlockDesign& design,
                                           const std::vector<std::vector<int>>& ratings) {
  std::vector<results::AnswerRow> answers;
  for (std::size_t person = 0; person < ratings.size(); ++person) {
    for (std::size_t i = 0; i < ratings[person].size(); ++i) {
      results::AnswerRow answer;
      answer.participant_id = "P" + std::to_string(person);
      answer.participant_index = static_cast<int>(person);
      answer.block = design.name;
      answer.stimulus = design.stimuli[i].name;
      answer.response = std::to_string(ratings[person][i]);
      answers.push_back(answer);
    }
  }
  return answers;
}

const std::vector<std::vector<int>> ratings{{5, 6, 3, 8}, {4, 4, 4, 7}, {6, 7, 5, 9},
                                            {3, 5, 4, 6}, {5, 5, 2, 6}, {7, 6}};  // one left early
}  // namespace

TEST_CASE("declared interactions and equivalences are tested of those with all values",
          "[analysis][report][planned]") {
  BlockDesign block = rated_design();
  block.comparisons = {
      {{"both", "They interact.", ""}, {"material", "structure"}},
      {{"same", "They are alike.", "mdf_two"}, {}, "mdf_three", "", 1.5},
  };
  StudyDesign design{"A study", "", {block}};
  const Summary summary = summarise(design, answers_of(block, ratings), {});
  const auto& found = summary.blocks.front()->hypotheses;
  REQUIRE(found.size() == 2);
  std::vector<LevelTable> people;
  std::vector<double> differences;
  for (const std::vector<int>& of : ratings) {
    differences.push_back(of[0] - of[1]);
    if (of.size() == 4) {
      people.push_back({{1.0 * of[0], 1.0 * of[1]}, {1.0 * of[2], 1.0 * of[3]}});
    }
  }
  const InteractionTest interaction = interaction_test(people, 1);
  CHECK(*found[0].p == Approx(interaction.p));
  CHECK_THAT(found[0].test, Contains("exact permutation test") &&
                                Contains("material and structure") && Contains("mean ratings") &&
                                Contains("5 of 6 participants"));
  CHECK_THAT(found[0].finding, Contains("F(1, 4) = "));
  const EquivalenceTest equivalence = equivalence_test(differences, 1.5);
  CHECK(*found[1].p == Approx(equivalence.p));
  CHECK_THAT(found[1].test, Contains("against -1.5 and 1.5") && Contains("6 participants"));
  CHECK_THAT(found[1].finding, Contains("mean difference -0.5, 90 % CI"));
  // both are adjusted with all declared hypotheses (Holm 1979)
  REQUIRE(found[0].p_holm);
  CHECK(std::max(*found[0].p_holm, *found[1].p_holm) ==
        Approx(std::max({*found[0].p, *found[1].p, 2.0 * std::min(*found[0].p, *found[1].p)})));
}

namespace {
struct ThresholdStudy {
  StudyDesign design;
  std::vector<std::shared_ptr<BlockSummary>> blocks;
  PersonalValues& add(const std::string& name, const std::map<std::string, double>& thresholds) {
    BlockDesign block;
    block.name = name;
    design.blocks.push_back(block);
    blocks.push_back(std::make_shared<BlockSummary>(block));
    blocks.back()->personal = PersonalValues{"threshold", true, thresholds};
    return *blocks.back()->personal;
  }
  HypothesisResult test(const PlannedComparison& planned) {
    design.blocks.front().comparisons = {planned};
    add_planned_comparisons(design, {{"first", {}}}, blocks);
    return blocks.front()->hypotheses.back();
  }
};
}  // namespace

TEST_CASE("blocks are equivalent by ratios where they measure ratios",
          "[analysis][report][planned]") {
  ThresholdStudy study;
  study.add("first", {{"A", 0.10}, {"B", 0.20}, {"C", 0.30}, {"D", 0.40}});
  study.add("second", {{"A", 0.11}, {"B", 0.19}, {"C", 0.31}}).beyond["D"] = {
      0.5, std::numeric_limits<double>::infinity()};
  const PlannedComparison planned{{"same", "", ""}, {}, "", "second", 1.25, {}};
  const HypothesisResult found = study.test(planned);
  REQUIRE(found.p);
  CHECK_THAT(found.test, Contains("with those beyond the levels, against 0.8 and 1.25") &&
                             Contains("4 participants, 1 of them beyond the levels"));
  const EquivalenceTest of_three = equivalence_test(
      std::vector{std::log(0.10 / 0.11), std::log(0.20 / 0.19), std::log(0.30 / 0.31)},
      std::log(1.25));
  CHECK(of_three.p < 0.05);
  CHECK(*found.p > 0.05);  // by construction the fourth is not equal
  SECTION("and not where one of them measures something else") {
    study.blocks.back()->personal->measure = "share";
    CHECK_FALSE(study.test(planned).p);
  }
}

// Of eight people who all point the same way 2 of 2^8 patterns of signs are as extreme.
TEST_CASE("a claim about thresholds is tested of all, also of those beyond the levels",
          "[analysis][report][planned]") {
  ThresholdStudy study;
  study.add("first", {{"A", 0.10},
                      {"B", 0.12},
                      {"C", 0.11},
                      {"D", 0.15},
                      {"E", 0.09},
                      {"F", 0.13},
                      {"G", 0.10},
                      {"H", 0.14}});
  PersonalValues& second = study.add("second", {{"A", 0.20}, {"B", 0.31}});
  for (const char* const name : {"C", "D", "E", "F", "G", "H"}) {
    second.beyond[name] = {0.4, std::numeric_limits<double>::infinity()};
  }
  const HypothesisResult differ = study.test({{"other", "", ""}, {}, "", "second", 0.0, {}});
  REQUIRE(differ.p);
  CHECK(*differ.p == Approx(2.0 / 256.0));
  CHECK_THAT(differ.test,
             Contains("two-sided") && Contains("; 8 participants, 6 of them beyond the levels"));
  const HypothesisResult below = study.test({{"fine", "", ""}, {}, "", "", 0.0, 0.16});
  REQUIRE(below.p);
  CHECK(*below.p == Approx(1.0 / 256.0));
  CHECK(*study.test({{"finer", "", ""}, {}, "", "", 0.0, 0.05}).p == Approx(255.0 / 256.0));
  PersonalValues& first = *study.blocks.front()->personal;
  for (const auto& [name, threshold] : first.by_participant) {
    first.beyond[name] = {0.0, 0.05};  // right at every level that was presented
  }
  first.by_participant.clear();
  const HypothesisResult of_none = study.test({{"fine", "", ""}, {}, "", "", 0.0, 0.16});
  REQUIRE(of_none.p);
  CHECK(*of_none.p == Approx(1.0 / 256.0));
  CHECK_THAT(of_none.finding, Contains("by order alone"));
}
