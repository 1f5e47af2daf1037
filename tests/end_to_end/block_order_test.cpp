// Blocks whose order is balanced over participants, through a whole study.
#include <nlohmann/json.hpp>

#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
// The paper's study twice, in blocks of two plates each.
std::string two_blocks() {
  const std::string paper = testing::contents(testing::shipped("paper/discrimination.yaml"));
  return paper.substr(0, paper.find("\nblocks:")) + R"(
blocks:
  - {name: first, task: identification, question: "Which?", stimuli: [mdf_two, mdf_three],
     repetitions: 4, catch_trials: {count: 2, expected: {mdf_two: mdf_two}}}
  - {name: second, task: identification, question: "Which?", stimuli: [acrylic_two, acrylic_three],
     repetitions: 3}
block_order: {order: williams}
)";
}
}  // namespace

TEST_CASE("blocks in balanced orders are simulated, verified and reported as they came",
          "[end_to_end]") {
  const testing::TempDirectory directory;
  testing::write(directory / "study.yaml", two_blocks());
  const std::string out = directory / "out";
  const auto checked =
      testing::tapstudy({"check", directory / "study.yaml", "--participants", "3"});
  CHECK_THAT(checked.standard_output, Contains("do not balance the 2 orders of the blocks"));
  REQUIRE(testing::tapstudy({"simulate", directory / "study.yaml", "--participants", "4", "--seed",
                             "3", "--out", out})
              .exit_code == 0);
  CHECK(testing::run_program({"/usr/bin/sqlite3", out + "/study.db",
                              "SELECT block, count(*) FROM trial WHERE number = 1 GROUP BY block"})
            .standard_output == "first|2\nsecond|2\n");
  CHECK(testing::tapstudy({"verify", out}).exit_code == 0);
  REQUIRE(testing::tapstudy({"report", out}).exit_code == 0);
  const auto report = nlohmann::json::parse(testing::contents(out + "/report.json"));
  for (const auto& block : report["blocks"]) {
    const double p = block["accuracy_estimates"][0]["p"];
    CHECK(p > 0.0);
    CHECK(p <= 1.0);
  }
  CHECK_THAT(testing::contents(out + "/report.html"),
             Contains("exchanged their places among participants"));
}
