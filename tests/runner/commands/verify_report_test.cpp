// Reports in a study's directory, which `verify` makes anew.
#include "support/blocks.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

TEST_CASE("a report of any parts of a study verifies, and a remark in it that is none of them not",
          "[end_to_end][verify]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "study.yaml";
  const std::string study = directory / "study";
  testing::write(file,
                 testing::text_with_blocks({"one", "two"}, "groups: [{name: a}, {name: b}]\n"));
  REQUIRE(
      testing::tapstudy({"simulate", file, "--participants", "4", "--no-traces", "--out", study})
          .exit_code == 0);
  for (const std::string parts : {"two,groups", "one,two,contrasts", "groups", "sessions"}) {
    CAPTURE(parts);
    REQUIRE(testing::tapstudy({"report", study, "--replace", "--only", parts}).exit_code == 0);
    const auto verified = testing::tapstudy({"verify", study});
    INFO(verified.standard_output);
    CHECK(verified.exit_code == 0);
  }
  REQUIRE(testing::tapstudy({"report", study, "--replace", "--only", "groups"}).exit_code == 0);
  const std::string report = study + "/report/report.json";
  testing::write(report, testing::replaced(testing::contents(report), "Of different people",
                                           "Of the same people"));
  CHECK(testing::tapstudy({"verify", study}).exit_code == 5);
}
