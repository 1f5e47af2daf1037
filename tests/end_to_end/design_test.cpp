// Blocks whose order is balanced over participants, through a whole study.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/random/rng.hpp"
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
  const auto report = nlohmann::json::parse(testing::contents(out + "/report/report.json"));
  for (const auto& block : report["blocks"]) {
    const double p = block["accuracy_estimates"][0]["p"];
    CHECK(p > 0.0);
    CHECK(p <= 1.0);
  }
  CHECK_THAT(testing::contents(out + "/report/report.html"),
             Contains("exchanged their places among participants"));
}

// What `check --simulations` says of a design, against the studies simulated and reported one by
// one.
using testing::TempDirectory;

namespace {
const std::string study = testing::shipped("examples/stiffness_jnd.yaml").string();
const std::vector<std::string> participants{"--participants", "6"};

testing::ProgramResult tapstudy_with_participants(std::vector<std::string> line) {
  line.insert(line.end(), participants.begin(), participants.end());
  return testing::tapstudy(line);
}

// Estimate and interval over the participants.
std::array<double, 3> reported(const TempDirectory& directory, int number) {
  const std::string out = directory / fmt::format("study_{}", number);
  const std::uint64_t seed =
      core::derived_seed(5, core::Purpose::study, static_cast<std::uint64_t>(number));
  REQUIRE(
      tapstudy_with_participants({"simulate", study, "--seed", std::to_string(seed), "--out", out})
          .exit_code == 0);
  REQUIRE(testing::tapstudy({"report", out}).exit_code == 0);
  const auto report = nlohmann::json::parse(testing::contents(out + "/report/report.json"));
  const auto pooled = report.at("blocks").at(0).at("pooled").at(0);
  return {pooled.at("weber_fraction").get<double>(), pooled.at("weber_fraction_low").get<double>(),
          pooled.at("weber_fraction_high").get<double>()};
}
}  // namespace

TEST_CASE("check says how the results of simulated studies scatter, and how wide intervals are",
          "[end_to_end][slow]") {
  const TempDirectory directory;
  const auto first = reported(directory, 0);
  const auto second = reported(directory, 1);
  const double mean = (first[0] + second[0]) / 2.0;
  const double spread = std::abs(first[0] - second[0]) / std::sqrt(2.0);
  const double width = (first[2] - first[1] + second[2] - second[1]) / 2.0;
  const auto checked =
      tapstudy_with_participants({"check", study, "--seed", "5", "--simulations", "2"});
  REQUIRE(checked.exit_code == 0);
  CHECK_THAT(checked.standard_output,
             Contains("2 simulated studies of 6 participants") &&
                 Contains(fmt::format("Weber fraction of Young's modulus {:.3g}, standard "
                                      "deviation {:.2g} between studies; median width of the 95 % "
                                      "intervals {:.2g}",
                                      mean, spread, width)));
}

TEST_CASE("a number of simulations that is none is refused", "[end_to_end]") {
  const auto refused = testing::tapstudy({"check", study, "--simulations", "-1"});
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.standard_error, Contains("--simulations: -1 is not allowed"));
}
