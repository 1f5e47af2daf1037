#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <regex>
#include <sstream>

#include "analysis/report/study/adaptive_tracks.hpp"
#include "analysis/report/study/confidence.hpp"
#include "analysis/report/study/course.hpp"
#include "analysis/report/study/questionnaires.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "support/catch.hpp"
#include "support/formats.hpp"
#include "support/reference_programs.hpp"
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

using namespace tapstudy::analysis;

namespace {
results::ParticipantCourseRow eventful() {
  results::ParticipantCourseRow row;
  row.participant_id = "P01";
  row.exclusion_reason = "a < b & c";
  row.sessions = 2;
  row.answered = 31;
  row.interrupted = 37;
  row.catch_trials = 4;
  row.catch_right = 3;
  row.ticks = 100'003;
  row.lateness_p999_s = 0.000123;
  row.worst_lateness_s = 0.00456;
  row.impacts = 47;
  row.late_impacts = 5;
  row.stored_trials = 68;
  row.masked_trials = 30;
  row.masking_low_db = -31.0;
  row.masking_high_db = -29.0;
  return row;
}
results::ParticipantCourseRow unmasked() {
  results::ParticipantCourseRow row;
  row.participant_id = "P02";
  row.stored_trials = 29;
  return row;
}
std::vector<ReportSection> sections() {
  return {course_section({eventful(), unmasked()},
                         {{"P01", "warm_up", {3, 4}, true}, {"P01", "more", {}, {}}}, true)};
}
}  // namespace

TEST_CASE("a table of participants shows so many rows on the terminal and counts the others",
          "[analysis][course]") {
  ReportTable table{"people", "People", {{"participant", {"participant"}}, {"number", {"number"}}}};
  for (int i = 0; i < 40; ++i) {
    table.rows.push_back({word(fmt::format("P{:02}", i)), count(i)});
  }
  const auto lines_with_person = [&](std::size_t most_lines) {
    std::ostringstream text;
    write_contents_text(text, {"", {table}}, most_lines);
    const std::string all = text.str();
    const std::regex person{"P[0-9][0-9]"};
    CHECK(all.find("… and 25 more (--all; people in the files)") ==
          (most_lines == 15 ? all.rfind("  … and") + 2 : std::string::npos));
    return std::distance(std::sregex_iterator{all.begin(), all.end(), person}, {});
  };
  CHECK(lines_with_person(15) == 15);
  CHECK(lines_with_person(all_lines) == 40);
  CHECK(lines_with_person(40) == 40);
  table.columns.front().heading = "pair";  // means and pairs are results
  std::ostringstream whole;
  write_contents_text(whole, {"", {table}}, 15);
  CHECK_THAT(whole.str(), Contains("P39") && !Contains("more"));
}

TEST_CASE("the course of a session reads the same in text, HTML and JSON", "[analysis][course]") {
  std::ostringstream text;
  write_sections_text(text, sections());
  std::ostringstream html;
  write_sections_html(html, sections(), "study", true);
  for (const char* shown :
       {"37", "31", "3/4", "5/47", "30/68", "0/29", "0.123", "4.56", "-31 to -29", "met"}) {
    INFO(shown);
    CHECK(text.str().find(shown) != std::string::npos);
    const std::string with_minus = std::regex_replace(std::string{shown}, std::regex{"-"}, "−");
    CHECK(html.str().find(with_minus) != std::string::npos);
  }
  CHECK(html.str().find("a &lt; b &amp; c") != std::string::npos);
  CHECK(testing::longest_line(text.str()) <= 100);
  nlohmann::ordered_json json;
  add_sections(json, sections());
  CHECK(json.at("course").at(0).at("interrupted") == 37);
  CHECK(json.at("loop_quality").at(0).at("worst_lateness_s") == 0.00456);
  CHECK(json.at("practice").at(0).at("right_of") == 4);
  CHECK(json.at("practice").at(1).at("is_criterion_met").is_null());
}

TEST_CASE("a store without ticks and practice leaves their tables out with a word",
          "[analysis][course]") {
  results::ParticipantCourseRow row;
  row.participant_id = "P01";
  const ReportSection section = course_section({row}, {}, false);
  for (const ReportTable& table : section.tables) {
    CHECK(table.rows.empty() == (table.name != "course"));
  }
  CHECK(section.remarks.back() == "In virtual time no tick is late.");
}

TEST_CASE("of simulated participants saturated ticks are told, where there were any",
          "[analysis][course]") {
  results::ParticipantCourseRow row = eventful();
  row.mode = results::Mode::simulated;
  row.saturated = 78;
  const auto saturation_of = [](const results::ParticipantCourseRow& participant) {
    nlohmann::ordered_json json;
    add_sections(json, {course_section({participant}, {}, true)});
    CHECK(json.at("masking").empty());  // nobody heard any
    return json.at("saturation");
  };
  CHECK(saturation_of(row).at(0).at("saturated") == 78);
  CHECK(saturation_of(row).at(0).at("saturated_of") == 100'003);
  row.saturated = 0;
  CHECK(saturation_of(row).empty());
}

namespace {
analysis::TrackResult track(const std::string& participant, double estimate, bool is_signed) {
  analysis::TrackResult result;
  result.participant_id = participant;
  result.block = "block";
  result.procedure = "staircase";
  result.estimate = estimate;
  result.is_signed = is_signed;
  return result;
}

// Mean and interval.
std::vector<double> mean_in(const std::vector<analysis::TrackResult>& tracks) {
  const analysis::ReportTable means = analysis::procedures_section(tracks).tables.front();
  REQUIRE(means.rows.size() == 1);
  std::vector<double> values;
  for (const analysis::Value& value : means.rows.front().at(3).values) {
    values.push_back(std::get<double>(value));
  }
  return values;
}

// Of Student's t with one degree of freedom, which is Cauchy's distribution.
const double t_of_two = std::tan(0.475 * std::numbers::pi);
}  // namespace

TEST_CASE("the mean of procedures' estimates counts each participant once, as logarithms",
          "[analysis][procedures]") {
  const std::vector<double> mean =
      mean_in({track("P1", 1.0, false), track("P1", 100.0, false), track("P2", 1000.0, false)});
  CHECK(mean.at(0) == Approx(100.0));
  CHECK(std::log10(mean.at(1)) == Approx(2.0 - t_of_two));
  CHECK(std::log10(mean.at(2)) == Approx(2.0 + t_of_two));
}

TEST_CASE("levels on both sides of a standard are averaged as they are", "[analysis][procedures]") {
  const std::vector<double> mean = mean_in({track("P1", -0.5, true), track("P2", 0.1, true)});
  CHECK(mean.at(0) == Approx(-0.2));
  CHECK(mean.at(2) == Approx(-0.2 + 0.3 * t_of_two));
}

namespace {
constexpr int people = 9;
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
m, v, e = np.mean(scores) / 100, np.var(scores, ddof=1) / 1e4, len(scores)
e = stats.t.ppf(.975, e - 1)**2 * v / (m * (1 - m)) / e  # roots of (m - x)^2 = e x (1 - x)
ci = np.sort(np.roots([1 + e, -2 * m - e, m * m])) * 100
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
      const bool is_of_row = answer.asked == row.at("asked").get<std::string>() &&
                             answer.item == row.at("item").get<std::string>();
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
  write_sections_html(all, sections, "study", true);
  for (const ReportTable* const table : csv_tables(sections)) {
    write_table_csv(all, *table);
  }
  all << json_of(answers);
  CHECK(all.str().find("secret") == std::string::npos);
  CHECK(all.str().find("remarks") != std::string::npos);
  answers[4].answer = "much";
  CHECK_THROWS_AS(json_of(answers), core::InvalidInput);
  answers[4].answer = "1.5";
  CHECK_THROWS_AS(json_of(answers), core::InvalidInput);
}

TEST_CASE("a report says of how many tracks an estimate lies at the end of its grid",
          "[analysis][procedures]") {
  std::vector<analysis::TrackResult> tracks{track("P1", 1.0, false), track("P2", 2.0, false)};
  for (analysis::TrackResult& of : tracks) {
    of.parameters = {{"threshold", 1.0, {0.5, 2.0}, 0.3}, {"slope", 5.0, {4.0, 5.0}, 0.2}};
  }
  CHECK(analysis::procedures_section(tracks).remarks.size() == 1);
  tracks.back().parameters.back().is_at_end = true;
  const auto remarks = analysis::procedures_section(tracks).remarks;
  REQUIRE(remarks.size() == 2);
  CHECK_THAT(remarks.back().words, Contains("grid: slope in 'block' of 1 of 2 tracks."));
}
