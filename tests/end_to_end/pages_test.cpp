// The pages of a live session, in a browser (Chromium, driven by Selenium) and against attacks.
#include <cstdlib>
#include <regex>

#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
#include "support/processes.hpp"
#include "support/study_files.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
const std::string every_way = "every_way_test.py";
const std::string whole_sessions = "whole_sessions_test.py";

// All of a script's tests, or those of one class.
void pass(const std::string& script, const std::string& tests = "") {
  const auto result = testing::run_script(
      "pages/" + script, tests.empty() ? std::vector<std::string>{} : std::vector{tests});
  INFO(result.standard_output << result.standard_error);
  CHECK(result.exit_code == 0);
}
}  // namespace

TEST_CASE("the pages' server serves nobody else, and a flood of requests stops no session",
          "[end_to_end][pages][slow][waits]") {
  pass("server_test.py");
}

TEST_CASE("the operator sees at the terminal what the page shows",
          "[end_to_end][pages][slow][waits]") {
  pass("operator_terminal_test.py");
}

TEST_CASE("every task of fixed stimuli is the same at the terminal and at the page, and simulated",
          "[end_to_end][pages][slow][waits]") {
  pass(every_way, "OfFixedStimuli");
}

TEST_CASE(
    "a comparison by every procedure is the same at the terminal and at the page, and simulated",
    "[end_to_end][pages][slow][waits]") {
  pass(every_way, "Comparison");
}

TEST_CASE(
    "an odd one out by every procedure is the same at the terminal and at the page, and simulated",
    "[end_to_end][pages][slow][waits]") {
  pass(every_way, "OddOneOut");
}

TEST_CASE(
    "every other task by every procedure is the same at the terminal and at the page, and "
    "simulated",
    "[end_to_end][pages][slow][waits]") {
  pass(every_way, "OtherTasks");
}

TEST_CASE("what was confirmed on a screen is stored once, however often the program is killed",
          "[end_to_end][pages][slow][waits]") {
  setenv("TAPSTUDY_KILLS", "12", 0);  // more of them by hand
  pass("kill_test.py");
}

#if !TAPSTUDY_SANITIZED  // what is drawn does not depend on it
TEST_CASE("a report is readable to everybody, on a screen, a phone and paper",
          "[end_to_end][pages][slow][waits]") {
  pass("report_test.py");
}
#endif

#if !TAPSTUDY_SANITIZED  // the mocked kernel is not theirs
TEST_CASE("a SPIDAR is homed by the operator's command while the participant is at a page",
          "[end_to_end][pages][slow][waits]") {
  const testing::TempDirectory directory;
  testing::write_patient_spidar_study(directory);
  setenv("TAPSTUDY_SPIDAR_STUDY", directory.path().c_str(), 1);
  setenv("TAPSTUDY_LAB", testing::lab_program().c_str(), 1);
  pass("spidar_page_test.py");
}
#endif

#if !TAPSTUDY_SANITIZED  // what is drawn and clicked does not depend on it
TEST_CASE("discrimination is answered in a browser, by mouse and by keyboard, and operated",
          "[end_to_end][pages][slow][waits]") {
  pass(whole_sessions, "Discrimination");
}

TEST_CASE("reality assessment is answered in a browser, by mouse and by keyboard, and operated",
          "[end_to_end][pages][slow][waits]") {
  pass(whole_sessions, "Reality");
}

TEST_CASE("every task is answered in a browser, by mouse and by keyboard",
          "[end_to_end][pages][slow][waits]") {
  pass(whole_sessions, "EveryTask");
}

TEST_CASE("every screen comes in its order and takes answers as people give and change them",
          "[end_to_end][pages][slow][waits]") {
  pass(whole_sessions, "EveryScreen");
}

TEST_CASE("operators, vanished pages and killed browsers interrupt a session that loses no answer",
          "[end_to_end][pages][slow][waits]") {
  pass(whole_sessions, "Interruption");
}
#endif

// A session at a pseudo-terminal, as a participant has it.
TEST_CASE("the paper's three studies are answered at a terminal, which may stop or vanish",
          "[end_to_end][slow]") {
  const auto result = testing::run_script("terminal/terminal_session_test.py");
  INFO(result.standard_output << result.standard_error);
  CHECK(result.exit_code == 0);
}

TEST_CASE("each class of the pages' scripts is run by a test of its own", "[end_to_end][pages]") {
  const std::string tests = testing::contents(testing::source("tests/end_to_end/pages_test.cpp"));
  const std::regex class_of_tests{R"re(class (\w+)\((?:EveryWay|WholeSession)\))re"};
  for (const std::string& script : {every_way, whole_sessions}) {
    const std::string text = testing::contents(testing::source("tests/pages/" + script));
    std::sregex_iterator found{text.begin(), text.end(), class_of_tests};
    REQUIRE(found != std::sregex_iterator{});
    for (; found != std::sregex_iterator{}; ++found) {
      CHECK_THAT(tests, Contains("\"" + (*found)[1].str() + "\""));
    }
  }
}
