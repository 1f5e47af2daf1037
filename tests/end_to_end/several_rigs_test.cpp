// A study that was run on several machines, each with a store of its own.
#include <nlohmann/json.hpp>

#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using testing::TempDirectory;

namespace {
void run(const std::string& protocol, const std::string& participant, const std::string& out,
         const std::string& answers) {
  const auto session = testing::tapstudy({"run", protocol, "--participant", participant, "--seed",
                                          participant == "P01" ? "5" : "6", "--out", out},
                                         answers);
  INFO(session.standard_error);
  REQUIRE(session.exit_code == 0);
}
testing::ProgramResult report(const TempDirectory& directory,
                              const std::vector<std::string>& studies, const std::string& out) {
  std::vector<std::string> line{"report", "--out", directory / out};
  for (const std::string& study : studies) {
    line.push_back(directory / study);
  }
  return testing::tapstudy(line);
}
// What does not depend on how fast the hand tapped and the program answered.
nlohmann::json answered(const TempDirectory& directory, const std::string& out) {
  nlohmann::json block =
      nlohmann::json::parse(testing::contents((directory / out) + "/report.json"))
          .at("blocks")
          .at(0);
  for (const char* const timed :
       {"response_times", "conditional_accuracy", "balanced_integration", "exploration"}) {
    REQUIRE(block.erase(timed) == 1);
  }
  return block;
}
const std::string first = "1\n2\n3\n4\n1\n2\n3\n4\n";
const std::string second = "4\n4\n3\n1\n1\n2\n2\n4\n";
}  // namespace

TEST_CASE("participants of two rigs are reported as if all had sat at one",
          "[end_to_end][report]") {
  const TempDirectory directory;
  const std::string study = testing::shipped("paper/discrimination.yaml").string();
  run(study, "P01", directory / "left", first);
  run(study, "P02", directory / "right", second);
  run(study, "P01", directory / "one", first);
  run(study, "P02", directory / "one", second);
  REQUIRE(report(directory, {"left", "right"}, "merged").exit_code == 0);
  REQUIRE(report(directory, {"one"}, "whole").exit_code == 0);
  CHECK(answered(directory, "merged") == answered(directory, "whole"));
}

TEST_CASE("studies that do not belong together are not reported together", "[end_to_end][report]") {
  const TempDirectory directory;
  const std::string study = testing::shipped("paper/discrimination.yaml").string();
  const std::string other = directory / "other.yaml";
  testing::write(other,
                 testing::replaced(testing::contents(study), "mass_kg: 0.058", "mass_kg: 0.057"));
  run(study, "P01", directory / "left", first);
  run(study, "P01", directory / "again", first);
  run(other, "P02", directory / "other", second);
  const auto twice = report(directory, {"left", "again"}, "merged");
  CHECK(twice.exit_code == 2);
  CHECK_THAT(twice.standard_error, Contains("participant P01 is in"));
  const auto mixed = report(directory, {"left", "other"}, "merged");
  CHECK(mixed.exit_code == 2);
  CHECK_THAT(mixed.standard_error, Contains("hold different protocols"));
  const auto nowhere = testing::tapstudy({"report", directory / "left", directory / "again"});
  CHECK(nowhere.exit_code == 2);
  CHECK_THAT(nowhere.standard_error, Contains("--out: a report of several directories"));
  CHECK_FALSE(std::filesystem::exists(directory / "merged"));
}
