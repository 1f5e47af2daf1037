// The pages of a live session, in a browser (Chromium, driven by Selenium) and against attacks.
#include <cstdlib>

#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
#include "support/processes.hpp"
#include "support/study_files.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
void pass(const std::string& script) {
  setenv("TAPSTUDY_PROGRAM", testing::tapstudy_program().c_str(), 1);
  const auto result =
      testing::run_program({"/usr/bin/python3", "-B", testing::source("tests/pages/" + script)});
  INFO(result.standard_output << result.standard_error);
  CHECK(result.exit_code == 0);
}
}  // namespace

TEST_CASE("the pages' server serves nobody else, and a flood of requests stops no session",
          "[end_to_end][pages][slow]") {
  pass("server_test.py");
}

TEST_CASE("the operator sees at the terminal what the page shows", "[end_to_end][pages][slow]") {
  pass("operator_terminal_test.py");
}

TEST_CASE(
    "every task with every procedure is the same at the terminal and at the page, and simulated",
    "[end_to_end][pages][slow]") {
  pass("every_way_test.py");
}

TEST_CASE("what was confirmed on a screen is stored once, however often the program is killed",
          "[end_to_end][pages][slow]") {
  setenv("TAPSTUDY_KILLS", "12", 0);  // more of them by hand
  pass("kill_test.py");
}

#if !TAPSTUDY_SANITIZED  // what is drawn does not depend on it
TEST_CASE("a report is readable to everybody, on a screen, a phone and paper",
          "[end_to_end][pages][slow]") {
  pass("report_test.py");
}
#endif

#if !TAPSTUDY_SANITIZED  // the mocked kernel is not theirs
TEST_CASE("a SPIDAR is homed by the operator's command while the participant is at a page",
          "[end_to_end][pages][slow]") {
  const testing::TempDirectory directory;
  testing::write_patient_spidar_study(directory);
  setenv("TAPSTUDY_SPIDAR_STUDY", directory.path().c_str(), 1);
  setenv("TAPSTUDY_LAB", testing::lab_program().c_str(), 1);
  pass("spidar_page_test.py");
}
#endif

#if !TAPSTUDY_SANITIZED  // what is drawn and clicked does not depend on it
TEST_CASE("the paper's three studies are answered in a browser, by mouse and by keyboard",
          "[end_to_end][pages][slow]") {
  pass("whole_sessions_test.py");
}
#endif

// A session at a pseudo-terminal, as a participant has it.
TEST_CASE("the paper's three studies are answered at a terminal, which may stop or vanish",
          "[end_to_end][slow]") {
  setenv("TAPSTUDY_PROGRAM", testing::tapstudy_program().c_str(), 1);
  const auto result = testing::run_program(
      {"/usr/bin/python3", "-B", testing::source("tests/terminal/terminal_session_test.py")});
  INFO(result.standard_output << result.standard_error);
  CHECK(result.exit_code == 0);
}
