#include "analysis/report/block_parts.hpp"

#include "core/error.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

namespace {
BlockDesign design() {
  BlockDesign design;
  design.name = "stiffness";
  design.question = "Which is stiffer?";
  design.further_axes = {{"damping_scale", "damping scale", ""}};
  return design;
}

results::AnswerRow answer_at(std::int64_t trial, double damping_scale) {
  results::AnswerRow answer;
  answer.trial_id = trial;
  answer.alternatives = {{0, "A", "plate", {{"damping_scale", damping_scale}}, false},
                         {1, "B", "plate", {{"damping_scale", damping_scale}}, true}};
  return answer;
}
}  // namespace

TEST_CASE("every answer is in the one part that has its values on the further axes",
          "[analysis][report]") {
  BlockRows rows;
  rows.answers = {answer_at(1, 2.0), answer_at(2, 0.5), answer_at(3, 2.0 + 1e-15),
                  answer_at(4, 2.0)};
  rows.orders = {{2, {0, 1}}, {4, {1, 0}}};
  const std::vector<BlockPart> parts = parts_at_further_values(design(), rows);
  REQUIRE(parts.size() == 2);
  CHECK(parts[0].design.name == "stiffness_at_damping_scale_0.5");
  CHECK(parts[1].design.name == "stiffness_at_damping_scale_2");
  CHECK(parts[1].design.question == "Which is stiffer? (damping scale 2)");
  REQUIRE(parts[0].rows.answers.size() == 1);
  CHECK(parts[0].rows.answers[0].trial_id == 2);
  CHECK(parts[1].rows.answers.size() == 3);
  REQUIRE(parts[1].rows.orders.size() == 1);
  CHECK(parts[1].rows.orders[0].trial_id == 4);
}

TEST_CASE("a block without further axes, or without answers, is one part", "[analysis][report]") {
  CHECK(parts_at_further_values(design(), {}).size() == 1);
  BlockDesign simple = design();
  simple.further_axes.clear();
  BlockRows rows;
  rows.answers = {answer_at(1, 2.0), answer_at(2, 0.5)};
  const std::vector<BlockPart> parts = parts_at_further_values(simple, rows);
  REQUIRE(parts.size() == 1);
  CHECK(parts[0].design.name == "stiffness");
  CHECK(parts[0].rows.answers.size() == 2);
}

TEST_CASE("an answer without a value on a further axis is refused", "[analysis][report]") {
  BlockRows rows;
  rows.answers = {answer_at(1, 2.0)};
  rows.answers[0].alternatives[0].axis_values.clear();
  CHECK_THROWS_AS(parts_at_further_values(design(), rows), core::InvalidInput);
}
