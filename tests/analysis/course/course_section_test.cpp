#include "analysis/course/course_section.hpp"

#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "support/catch.hpp"
#include "support/formats.hpp"
using namespace tapstudy;
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

TEST_CASE("the course of a session reads the same in text, HTML and JSON", "[analysis][course]") {
  std::ostringstream text;
  write_sections_text(text, sections());
  std::ostringstream html;
  write_sections_html(html, sections(), "study");
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
