#include <nlohmann/json.hpp>

#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
const char* const few_answers =
    "participant,stimulus,response\n1,a,a\n1,b,b\n2,a,b\n2,b,b\n3,a,a\n3,b,a\n";
const char* const others =
    "participant,stimulus,response\n1,a,a\n1,b,b\n2,a,a\n2,b,b\n3,a,b\n3,b,b\n";

nlohmann::json block_in(const std::string& directory) {
  return nlohmann::json::parse(testing::contents(directory + "/report.json"))["blocks"][0];
}
}  // namespace

TEST_CASE("two studies are compared by what their own reports say", "[end_to_end]") {
  const testing::TempDirectory directory;
  testing::write(directory / "first.csv", few_answers);
  testing::write(directory / "second.csv", others);
  for (const std::string name : {"first", "second"}) {
    REQUIRE(testing::tapstudy(
                {"report", "--counts", directory / (name + ".csv"), "--out", directory / name})
                .exit_code == 0);
  }
  REQUIRE(testing::tapstudy({"report", "--compare", directory / "first.csv",
                             directory / "second.csv", "--out", directory / "both"})
              .exit_code == 0);
  const nlohmann::json rows = block_in(directory / "both")["side_by_side"];
  REQUIRE(rows.size() == 3);
  CHECK(rows[0]["estimate"].get<double>() == 4.0 / 6.0);
  CHECK(rows[1]["estimate"].get<double>() == 5.0 / 6.0);
  for (const std::size_t i : {0U, 1U}) {
    const auto own = block_in(directory / (i == 0 ? "first" : "second"))["accuracy"];
    CHECK(rows[i]["estimate_low"] == own["over_participants_95"][0]);
    CHECK(rows[i]["estimate_high"] == own["over_participants_95"][1]);
  }
  CHECK(rows[2]["estimate"].get<double>() ==
        Approx(rows[1]["estimate"].get<double>() - rows[0]["estimate"].get<double>()));
  CHECK(rows[2]["estimate_low"] < rows[2]["estimate"]);
  CHECK_THAT(testing::contents((directory / "both") + "/report.html"),
             Contains("3 participants have an id in both studies (1, 2, 3)"));
}

TEST_CASE("shares of right answers at other levels of chance are not compared without a word",
          "[end_to_end]") {
  const testing::TempDirectory directory;
  testing::write(directory / "two.csv", few_answers);
  testing::write(directory / "three.csv",
                 "participant,stimulus,response\n5,a,a\n5,b,b\n5,c,c\n6,a,a\n6,b,b\n6,c,a\n");
  const auto said =
      testing::tapstudy({"report", "--compare", directory / "two.csv", directory / "three.csv"});
  REQUIRE(said.exit_code == 0);
  CHECK_THAT(said.standard_output, Contains("Guessing gives 0.5 in ") && Contains("0.333 in "));
}

TEST_CASE("a printed matrix is compared with a study of one block, whatever it is called",
          "[end_to_end]") {
  const testing::TempDirectory directory;
  testing::write(directory / "counts.csv", "stimulus,a,b\na,3,1\nb,0,4\n");
  testing::write(directory / "answers.csv", few_answers);
  const auto said = testing::tapstudy(
      {"report", "--compare", directory / "counts.csv", directory / "answers.csv"});
  INFO(said.standard_error);
  REQUIRE(said.exit_code == 0);
  CHECK_THAT(said.standard_output, Contains("accuracy") && Contains("0.875 (0.529 to 0.978)"));
}

TEST_CASE("studies with nothing in common are refused with the reasons", "[end_to_end]") {
  const testing::TempDirectory directory;
  testing::write(directory / "counts.csv", "stimulus,a,b\na,3,1\nb,0,4\n");
  const std::string study = directory / "choice";
  REQUIRE(testing::tapstudy({"simulate", testing::shipped("paper/reality_vibration.yaml").string(),
                             "--participants", "2", "--no-traces", "--out", study})
              .exit_code == 0);
  const auto refused = testing::tapstudy({"report", "--compare", directory / "counts.csv", study});
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.standard_error, Contains("nothing to compare") &&
                                         Contains("its task is identification in") &&
                                         Contains("choice in"));
  CHECK(testing::tapstudy({"report", "--compare", directory / "counts.csv"}).exit_code == 2);
}

TEST_CASE("thresholds are compared by their ratio, and not where they are of other proportions",
          "[end_to_end]") {
  const testing::TempDirectory directory;
  const std::string example = testing::contents(testing::shipped("examples/damping_jnd.yaml"));
  const auto block = example.find("    procedures:");
  REQUIRE(block != std::string::npos);
  testing::write(directory / "logistic.yaml",
                 example.substr(0, block) + "    function: log_logistic\n" + example.substr(block));
  testing::write(directory / "weibull.yaml",
                 example.substr(0, block) + "    function: weibull\n" + example.substr(block));
  int seed = 0;
  for (const std::string name : {"logistic", "weibull"}) {
    for (const std::string time : {"1", "2"}) {
      REQUIRE(testing::tapstudy({"simulate", directory / (name + ".yaml"), "--participants", "3",
                                 "--seed", std::to_string(++seed), "--no-traces", "--out",
                                 directory / (name + time)})
                  .exit_code == 0);
    }
  }
  REQUIRE(testing::tapstudy({"report", "--compare", directory / "weibull1", directory / "weibull2",
                             "--out", directory / "both"})
              .exit_code == 0);
  const auto rows = block_in(directory / "both")["side_by_side"];
  REQUIRE(rows.size() == 3);
  CHECK(rows[2]["study"] == "ratio");
  CHECK(rows[2]["estimate"].get<double>() ==
        Approx(rows[1]["estimate"].get<double>() / rows[0]["estimate"].get<double>()));
  const auto refused =
      testing::tapstudy({"report", "--compare", directory / "logistic1", directory / "weibull1"});
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.standard_error,
             Contains("log_logistic function") && Contains("weibull function"));
}
