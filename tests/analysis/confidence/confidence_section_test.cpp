#include "analysis/confidence/confidence_section.hpp"

#include "support/catch.hpp"
using namespace tapstudy;

TEST_CASE("confidence is counted by its steps, with what was right at each",
          "[analysis][confidence]") {
  std::vector<results::AnswerRow> answers;
  const auto add = [&](const std::string& participant, std::optional<int> confidence,
                       bool is_correct) {
    results::AnswerRow& answer = answers.emplace_back();
    answer.participant_id = participant;
    answer.block = "main";
    answer.confidence = confidence;
    answer.is_correct = is_correct;
  };
  add("a", 1, false);
  add("a", 3, true);
  add("b", 3, true);
  add("b", 3, false);
  add("b", std::nullopt, true);
  const auto section = analysis::confidence_section({{"main", 3, "guessed", "certain"}}, answers);
  REQUIRE(section.tables.size() == 1);
  const auto& rows = section.tables.front().rows;
  REQUIRE(rows.size() == 2);
  CHECK(rows[0][2].text == "guessed");
  CHECK(rows[1][3].text == "3");
  CHECK_THAT(rows[1][5].text, Catch::Matchers::StartsWith("2/3"));
  CHECK(analysis::confidence_section({{"other", 3, "", ""}}, answers).tables.empty());
}
