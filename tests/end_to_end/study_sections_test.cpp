// What a report says of a study besides its blocks.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "results/store.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
// Each participant marks every line of the task's load at a tenth of their session's id.
void answer_forms(const std::string& study) {
  results::Store store =
      results::Store::open_or_create(study, results::Store::open_existing(study).study());
  for (const results::SessionRow& session : store.sessions()) {
    std::vector<results::FormAnswerRow> answers;
    for (const char* scale : {"mental_demand", "physical_demand", "temporal_demand", "performance",
                              "effort", "frustration"}) {
      answers.push_back({session.id, 1.0, "load", "session end", scale,
                         fmt::format("{:.1f}", 0.1 * static_cast<double>(session.id))});
    }
    answers.push_back({session.id, 1.0, "about", "session begin", "why", "because of a secret"});
    store.add_form(answers);
  }
}
}  // namespace

TEST_CASE("a report has each participant's sessions and the load of the task",
          "[end_to_end][report]") {
  const testing::TempDirectory directory;
  const std::string protocol = directory / "study.yaml";
  testing::write(protocol, testing::contents(testing::shipped("paper/discrimination.yaml")) +
                               "\nforms:\n  load: {shipped: nasa_tlx}\n"
                               "  about:\n    title: You\n    items:\n"
                               "      - {name: why, kind: text, question: \"Why?\"}\n"
                               "forms_before: [about]\nforms_after: [load]\n");
  const std::string study = directory / "study";
  const auto simulated = testing::tapstudy(
      {"simulate", protocol, "--participants", "4", "--seed", "1", "--out", study});
  INFO(simulated.standard_error);
  REQUIRE(simulated.exit_code == 0);
  answer_forms(study);
  const auto report = testing::tapstudy({"report", study, "--out", directory / "report"});
  INFO(report.standard_error);
  REQUIRE(report.exit_code == 0);
  CHECK_THAT(report.standard_output, !Contains("How the sessions went"));  // the page says it
  CHECK_THAT(report.standard_output, !Contains("secret"));
  const std::string text = testing::contents((directory / "report") + "/report.json");
  CHECK_THAT(text, !Contains("secret"));
  const auto json = nlohmann::json::parse(text).at("study");
  REQUIRE(json.at("course").size() == 4);
  CHECK(json.at("course").at(0).at("mode") == "simulated");
  CHECK(json.at("course").at(0).at("answered") == 8);
  const auto& load = json.at("questionnaire_scores").at(0);
  CHECK(load.at("scored") == 4);
  CHECK(load.at("mean").get<double>() == Approx(25.0));  // of 10, 20, 30 and 40
  CHECK_THAT(testing::contents((directory / "report") + "/course.csv"),
             Contains("participant,mode,sessions,answered"));
}

TEST_CASE("the methods of a report name the procedures that chose the levels",
          "[end_to_end][report]") {
  const testing::TempDirectory directory;
  const auto methods_of = [&](const std::string& example) {
    const std::string study = directory / example;
    REQUIRE(
        testing::tapstudy({"simulate", testing::shipped("examples/" + example + ".yaml").string(),
                           "--participants", "1", "--no-traces", "--out", study})
            .exit_code == 0);
    REQUIRE(testing::tapstudy({"report", study, "--out", study + "_report"}).exit_code == 0);
    return testing::contents(study + "_report/report.html");
  };
  CHECK_THAT(methods_of("stiffness_jnd"),
             Contains("levels of Young's modulus by") && Contains("QUEST+ (Watson 2017)"));
  CHECK_THAT(methods_of("damping_jnd"), Contains("levels of damping scale by") &&
                                            Contains("staircase") && Contains("settles at"));
}

TEST_CASE("the methods of a report say what the protocol asked for and what it ran on",
          "[end_to_end][report]") {
  const testing::TempDirectory directory;
  const std::string study = directory / "study";
  std::string latest;
  const auto methods_of = [&](const std::string& protocol) {
    testing::write(directory / "study.yaml", protocol);
    const std::string out = study + std::to_string(protocol.size());
    latest = out;
    REQUIRE(testing::tapstudy({"run", directory / "study.yaml", "--participant", "P01", "--seed",
                               "5", "--out", out},
                              "1\n2\n3\n4\n1\n2\n3\n4\n")
                .exit_code == 0);
    REQUIRE(testing::tapstudy({"report", out, "--out", out + "_report"}).exit_code == 0);
    return testing::contents(out + "_report/report.html");
  };
  const std::string plain = testing::contents(testing::shipped("paper/discrimination.yaml"));
  const std::string text = methods_of(plain);
  CHECK_THAT(text, Contains("1 participant (pilot). Apparatus: "));
  CHECK_THAT(text, Contains("a spring of 3000 N/m with the technique fem; modes of vibration up to "
                            "300 Hz"));
  CHECK_THAT(text, Contains("(identification of 4 stimuli, 8 trials, in random order)"));
  CHECK_THAT(text, Contains("An answer required at least 1 contact. "));
  CHECK_THAT(text, Contains("screen showed what was presented"));
  CHECK_THAT(text, !Contains("Masking"));
  const std::string masked = methods_of(plain +
                                        "\nmasking: {kind: pink, level_db_fs: -24}\n"
                                        "display: {blind_operator: true}\n");
  CHECK_THAT(masked, Contains("Masking: the protocol asks for pink noise at -24 dB FS") &&
                         Contains("none was played"));
  CHECK_THAT(testing::contents(latest + "_report/masking.csv"), Contains("P01,0,8,"));
  CHECK_THAT(masked, Contains("screen did not show what was presented"));
  CHECK_THAT(masked, !Contains("letters"));
}

TEST_CASE(
    "a block that is called as a part of the report is keeps its tables apart from that part's",
    "[end_to_end][report]") {
  const testing::TempDirectory directory;
  const std::string study = directory / "study";
  testing::write(directory / "study.yaml",
                 testing::replaced(testing::contents(testing::source("tests/data/every_task.yaml")),
                                   "name: rating,", "name: rendered,"));
  REQUIRE(testing::tapstudy({"simulate", directory / "study.yaml", "--participants", "1", "--seed",
                             "1", "--out", study})
              .exit_code == 0);
  REQUIRE(testing::tapstudy({"report", study}).exit_code == 0);
  CHECK_THAT(testing::contents(study + "/rendered_stimuli.csv"), Contains("fixation"));
  CHECK_THAT(testing::contents(study + "/block_rendered_stimuli.csv"), Contains("median"));
}
