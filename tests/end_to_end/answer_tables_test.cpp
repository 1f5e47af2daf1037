#include <algorithm>
#include <nlohmann/json.hpp>

#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
nlohmann::json block_of(const std::string& report) {
  nlohmann::json block = nlohmann::json::parse(testing::contents(report))["blocks"][0];
  auto& people = block["participants"];
  std::sort(people.begin(), people.end(), [](const auto& one, const auto& other) {
    return one["participant_id"] < other["participant_id"];
  });
  return block;
}
}  // namespace

TEST_CASE("exported answers are counted as the study's own report counts them, and stay simulated",
          "[end_to_end]") {
  const testing::TempDirectory directory;
  REQUIRE(testing::tapstudy({"simulate", testing::shipped("paper/discrimination.yaml"),
                             "--participants", "3", "--seed", "5", "--out", directory / "study"})
              .exit_code == 0);
  REQUIRE(
      testing::tapstudy({"export", directory / "study", "--out", directory / "csv"}).exit_code ==
      0);
  const auto table = testing::tapstudy(
      {"report", "--counts", directory / "csv/trials.csv", "--out", directory / "of_table"});
  REQUIRE(table.exit_code == 0);
  CHECK_THAT(table.standard_output, Contains("SIMULATED"));
  REQUIRE(testing::tapstudy({"report", directory / "study", "--replace"}).exit_code == 0);
  const nlohmann::json own = block_of(directory / "study/report.json");
  const nlohmann::json read = block_of(directory / "of_table/report.json");
  for (const char* const key : {"successes", "trials", "value", "wilson_95"}) {
    CHECK(read["accuracy"][key] == own["accuracy"][key]);
  }
  for (const std::size_t end : {0U, 1U}) {  // sums in another order
    CHECK(read["accuracy"]["over_participants_95"][end].get<double>() ==
          Approx(own["accuracy"]["over_participants_95"][end].get<double>()).epsilon(1e-9));
  }
  CHECK(read["participants"] == own["participants"]);
  CHECK(read["response_times"][0] == own["response_times"][0]);
}

TEST_CASE("a file that is named twice is refused, not counted twice", "[end_to_end]") {
  const testing::TempDirectory directory;
  testing::write(directory / "answers.csv", "participant,stimulus,response\nP01,a,a\nP01,b,a\n");
  const auto run = testing::tapstudy(
      {"report", "--counts", directory / "answers.csv", directory / "answers.csv"});
  CHECK(run.exit_code == 2);
  CHECK_THAT(run.standard_error, Contains("holds the same rows as"));
}

TEST_CASE("an export says which of interleaved staircases chose each level", "[end_to_end]") {
  const testing::TempDirectory directory;
  const std::string study = directory / "s";
  REQUIRE(testing::tapstudy({"simulate", testing::shipped("examples/damping_jnd.yaml").string(),
                             "--participants", "1", "--seed", "2", "--out", study})
              .exit_code == 0);
  REQUIRE(testing::tapstudy({"export", study, "--out", directory / "e"}).exit_code == 0);
  REQUIRE(testing::tapstudy({"report", study}).exit_code == 0);
  // one line for each answer in either, of the same trials and tracks
  const auto both = testing::run_program(
      {"/usr/bin/python3", "-c",
       "import csv, sys\n"
       "exported = [(r['number'], r['track']) for r in csv.DictReader(open(sys.argv[1]))]\n"
       "reported = [(r['trial'], r['track']) for r in csv.DictReader(\n"
       "  line for line in open(sys.argv[2]) if not line.startswith('#'))]\n"
       "print(sorted(exported) == sorted(reported), len(set(t for _, t in exported)))\n",
       (directory / "e") + "/tracks.csv", study + "/damping_tracks.csv"});
  INFO(both.standard_error);
  CHECK(both.standard_output == "True 2\n");
}
