// The pages of a live session, in a browser (Chromium, driven by Selenium) and against attacks.
#include <catch2/catch.hpp>
#include <cstdlib>

#include "support/processes.hpp"
#include "support/sanitized.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
void pass(const std::string& script) {
  setenv("TAPSTUDY_PROGRAM", TAPSTUDY_PROGRAM, 1);
  const auto result =
      testing::run_program({"/usr/bin/python3", "-B", testing::source("tests/pages/" + script)});
  INFO(result.standard_output << result.standard_error);
  CHECK(result.exit_code == 0);
}
}  // namespace

TEST_CASE("the pages' server serves nobody else, and a flood of requests stops no session",
          "[end_to_end][pages]") {
  pass("server_test.py");
}

#if !TAPSTUDY_SANITIZED  // what is drawn and clicked does not depend on it
TEST_CASE("the paper's three studies are answered in a browser, by mouse and by keyboard",
          "[end_to_end][pages]") {
  pass("whole_sessions_test.py");
}
#endif
