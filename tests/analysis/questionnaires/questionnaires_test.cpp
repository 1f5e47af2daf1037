#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "analysis/questionnaires/questionnaires_section.hpp"
#include "core/error.hpp"
#include "core/rng.hpp"
#include "support/catch.hpp"
#include "support/python_program.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

namespace {
constexpr int people = 7;
const std::vector<std::string> scales{"mental_demand", "physical_demand", "temporal_demand",
                                      "performance",   "effort",          "frustration"};

Questionnaire task_load() {
  Questionnaire form{"load", {}, {"first", "second"}, true};
  for (const std::string& scale : scales) {
    form.items.push_back({scale, QuestionnaireKind::number, "How much?"});
  }
  return form;
}

Questionnaire about() {
  return {"about",
          {{"hand", QuestionnaireKind::choice, "Which?", {"left", "right"}},
           {"sure", QuestionnaireKind::steps, "How sure?", {"1", "2", "3"}},
           {"remarks", QuestionnaireKind::text, "What else?"}},
          {"session begin"}};
}

std::vector<GivenAnswer> given() {
  core::Rng rng{3};
  std::vector<GivenAnswer> answers;
  for (int person = 0; person < people; ++person) {
    const std::string id = fmt::format("P{:02}", person);
    for (const std::string asked : {"first", "second"}) {
      for (const std::string& scale : scales) {
        answers.push_back({id, "load", asked, scale, fmt::format("{:.3f}", rng.uniform())});
      }
    }
    answers.push_back({id, "about", "session begin", "hand", person < 2 ? "left" : "right"});
    answers.push_back({id, "about", "session begin", "sure", person < 3 ? "3" : "1"});
    answers.push_back({id, "about", "session begin", "remarks", "a secret of mine"});
  }
  answers[3].answer.reset();  // P00 leaves one scale out in the first block
  return answers;
}

nlohmann::ordered_json json_of(const std::vector<GivenAnswer>& answers) {
  nlohmann::ordered_json json;
  add_sections(json, {questionnaires_section({about(), task_load()}, answers)});
  return json;
}

std::string python_of(const std::vector<GivenAnswer>& answers, const std::string& asked) {
  std::string rows = "rows = {}\n";
  for (const GivenAnswer& answer : answers) {
    if (answer.form == "load" && answer.asked == asked && answer.answer) {
      rows += fmt::format("rows.setdefault('{}', []).append({})\n", answer.participant_id,
                          *answer.answer);
    }
  }
  return rows;
}
}  // namespace

TEST_CASE("raw task load is the mean of six scales, its interval Student's over participants",
          "[analysis][questionnaires]") {
  const auto answers = given();
  const auto json = json_of(answers);
  for (std::size_t place = 0; place < 2; ++place) {
    const auto& row = json.at("questionnaire_scores").at(place);
    const auto expected = testing::python_numbers(python_of(answers, row.at("asked")) + R"py(
from scipy import stats
scores = [100 * np.mean(r) for r in rows.values() if len(r) == 6]
ci = stats.t.interval(0.95, len(scores) - 1, np.mean(scores), stats.sem(scores))
n = len(scores)
tail = stats.norm.cdf(-np.sqrt(n / (n - 1)) * stats.t.ppf(.975, n - 1))  # Hesterberg 2015
boot = stats.bootstrap((scores,), np.mean, n_resamples=20000, method='BCa', random_state=1,
                       confidence_level=1 - 2 * tail)
out(len(scores), len(rows) - len(scores), np.mean(scores), ci[0], ci[1],
    boot.confidence_interval.low, boot.confidence_interval.high)
)py");
    CHECK(row.at("scored") == expected[0]);
    CHECK(row.at("incomplete") == expected[1]);
    CHECK(row.at("mean").get<double>() == Approx(expected[2]).epsilon(1e-9));
    CHECK(row.at("mean_low").get<double>() == Approx(expected[3]).epsilon(1e-9));
    CHECK(row.at("mean_high").get<double>() == Approx(expected[4]).epsilon(1e-9));
    CHECK(row.at("bootstrap_low").get<double>() == Approx(expected[5]).margin(1.0));
    CHECK(row.at("bootstrap_high").get<double>() == Approx(expected[6]).margin(1.0));
  }
}

TEST_CASE("the order in which participants came changes nothing", "[analysis][questionnaires]") {
  auto answers = given();
  const auto json = json_of(answers);
  std::ranges::reverse(answers);
  CHECK(json_of(answers) == json);
  std::rotate(answers.begin(), answers.begin() + 11, answers.end());
  CHECK(json_of(answers) == json);
}

TEST_CASE("quartiles of an item are numpy's, and every answer is counted once",
          "[analysis][questionnaires]") {
  const auto answers = given();
  const auto json = json_of(answers);
  const auto& items = json.at("questionnaire_items");
  for (const auto& row : items) {
    CHECK(row.at("answered").get<int>() + row.at("left_out").get<int>() == people);
    if (row.at("form") != "load") {
      continue;
    }
    std::string numbers;
    for (const GivenAnswer& answer : answers) {
      const bool is_of_row = answer.asked == row.at("asked") && answer.item == row.at("item");
      numbers += is_of_row && answer.answer ? *answer.answer + "," : "";
    }
    const auto expected =
        testing::python_numbers("out(np.quantile([" + numbers + "], [0.25, 0.5, 0.75]))");
    CHECK(row.at("quartile_low").get<double>() == Approx(expected[0]).epsilon(1e-9));
    CHECK(row.at("median").get<double>() == Approx(expected[1]).epsilon(1e-9));
    CHECK(row.at("quartile_high").get<double>() == Approx(expected[2]).epsilon(1e-9));
  }
  std::map<std::string, int> counted;
  for (const auto& row : json.at("questionnaire_answers")) {
    counted[row.at("item")] += row.at("participants").get<int>();
  }
  CHECK(counted == std::map<std::string, int>{{"hand", people}, {"sure", people}});
}

TEST_CASE("free text is in no format, and a mark that is no number is refused",
          "[analysis][questionnaires]") {
  auto answers = given();
  const std::vector<ReportSection> sections{
      questionnaires_section({about(), task_load()}, answers)};
  std::ostringstream all;
  write_sections_text(all, sections);
  write_sections_html(all, sections, "study");
  for (const CsvTable& table : csv_of(sections)) {
    table.write(all);
  }
  all << json_of(answers);
  CHECK(all.str().find("secret") == std::string::npos);
  CHECK(all.str().find("remarks") != std::string::npos);
  answers[4].answer = "much";
  CHECK_THROWS_AS(json_of(answers), core::InvalidInput);
  answers[4].answer = "1.5";
  CHECK_THROWS_AS(json_of(answers), core::InvalidInput);
}
