// `reproduce`: what it writes and where it refuses to.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using testing::TempDirectory;

namespace {
testing::ProgramResult reproduced(const std::string& directory) {
  return testing::tapstudy({"reproduce", "--only", "plate", "--quick", "--out", directory});
}
}  // namespace

TEST_CASE("a reproduction fits the schema that is shipped, and every verdict its numbers",
          "[end_to_end][reproduction]") {
  const TempDirectory directory;
  const std::string out = directory / "paper";
  const auto run = reproduced(out);
  REQUIRE(run.exit_code == 0);
  CHECK_THAT(run.standard_error, Contains("1 of 1: The plate model"));
  CHECK(std::filesystem::exists(out + "/reproduction.html"));
  const auto fits =
      testing::run_program({"/usr/bin/python3", testing::source("tests/protocols/validate.py"),
                            testing::source("runner/reproduction/reproduction.schema.json"),
                            out + "/reproduction.json"});
  INFO(fits.standard_error);
  CHECK(fits.exit_code == 0);
  const auto json = nlohmann::json::parse(testing::contents(out + "/reproduction.json"));
  CHECK(json["command"] == "tapstudy reproduce --only plate --quick --seed 1 --out DIR");
  for (const auto& claim : json["claims"]) {
    INFO(claim["name"]);
    std::size_t confirming = 0;
    for (const auto& method : claim["methods"]) {
      bool confirms = true;
      for (const auto& measure : method["measures"]) {
        const bool holds =
            (measure["at_least"].is_null() || measure["value"] >= measure["at_least"]) &&
            (measure["at_most"].is_null() || measure["value"] <= measure["at_most"]);
        CHECK(measure["holds"] == holds);
        confirms = confirms && holds;
      }
      CHECK(method["confirms"] == confirms);
      confirming += confirms ? 1 : 0;
    }
    CHECK(claim["verdict"] == (confirming == 0                         ? "false"
                               : confirming == claim["methods"].size() ? "true"
                                                                       : "depends"));
  }
}

TEST_CASE("a reproduction replaces nothing, and says at once where it cannot be written",
          "[end_to_end][reproduction]") {
  const TempDirectory directory;
  for (const char* const name : {"reproduction.html", "reproduction.json"}) {
    const std::string taken = directory / (std::string{"taken_"} + name);
    std::filesystem::create_directory(taken);
    testing::write(std::filesystem::path{taken} / name, "mine");
    const auto run = reproduced(taken);
    CHECK(run.exit_code == 2);
    CHECK_THAT(run.standard_error, Contains(name));
    CHECK_THAT(run.standard_error, !Contains("1 of 1"));
    CHECK(testing::contents(std::filesystem::path{taken} / name) == "mine");
    CHECK(testing::entries(taken) == 1);
  }
  testing::write(directory / "file", "");
  for (const std::string& nowhere : {directory / "file", std::string{"/proc/nowhere"}}) {
    const auto run = reproduced(nowhere);
    CHECK(run.exit_code == 2);
    CHECK_THAT(run.standard_error, Contains("cannot be made"));
    CHECK_THAT(run.standard_error, !Contains("1 of 1"));
  }
  const auto unknown = testing::tapstudy({"reproduce", "--only", "x", "--out", directory / "new"});
  CHECK(unknown.exit_code == 2);
  CHECK_THAT(unknown.standard_error, Contains("one of: plate, modes"));
}
