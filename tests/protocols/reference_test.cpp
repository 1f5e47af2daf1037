// protocols/README.md against the JSON schemas from which it is generated.
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

TEST_CASE("the reference of the keys says what the schemas say", "[protocols][schema]") {
  const auto result = testing::run_program(
      {"/usr/bin/python3", testing::shipped("schema/write_readme.py").string(), "--check"});
  INFO(result.standard_output << result.standard_error);
  CHECK(result.exit_code == 0);
}
