// A session at a pseudo-terminal, as a participant has it.
#include <cstdlib>

#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

TEST_CASE("the paper's three studies are answered at a terminal, which may stop or vanish",
          "[end_to_end][slow]") {
  setenv("TAPSTUDY_PROGRAM", testing::tapstudy_program().c_str(), 1);
  const auto result = testing::run_program(
      {"/usr/bin/python3", "-B", testing::source("tests/terminal/terminal_session_test.py")});
  INFO(result.standard_output << result.standard_error);
  CHECK(result.exit_code == 0);
}
