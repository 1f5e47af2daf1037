#include <nlohmann/json.hpp>

#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
// JSON is YAML.
testing::ProgramResult validated(const std::string& report) {
  return testing::run_program({"/usr/bin/python3", testing::source("tests/protocols/validate.py"),
                               testing::source("analysis/report/report.schema.json"), report});
}
std::string reported(const testing::TempDirectory& directory, const std::string& protocol) {
  const std::string study = directory / "study";
  REQUIRE(testing::tapstudy({"simulate", testing::shipped(protocol), "--participants", "2",
                             "--no-traces", "--out", study})
              .exit_code == 0);
  REQUIRE(testing::tapstudy({"report", study}).exit_code == 0);
  return study + "/report.json";
}
}  // namespace

TEST_CASE("reports fit the schema that is shipped", "[end_to_end]") {
  const testing::TempDirectory directory;
  const std::string protocol =
      GENERATE(as<std::string>{}, "paper/discrimination.yaml", "paper/reality_vibration.yaml",
               "examples/stiffness_jnd.yaml", "examples/triangle_mdf_acrylic.yaml",
               "examples/techniques_compared.yaml", "examples/hardness_magnitude.yaml",
               "examples/cantilever_techniques.yaml");
  const auto result = validated(reported(directory, protocol));
  INFO(protocol << ": " << result.standard_error);
  CHECK(result.exit_code == 0);
}

TEST_CASE("a report that is none does not fit the schema", "[end_to_end]") {
  const testing::TempDirectory directory;
  const nlohmann::json report = nlohmann::json::parse(
      testing::contents(reported(directory, "examples/hardness_magnitude.yaml")));
  const auto fits = [&](const nlohmann::json& changed) {
    testing::write(directory / "changed.json", changed.dump());
    return validated(directory / "changed.json").exit_code == 0;
  };
  CHECK(fits(report));
  for (const char* const path :
       {"/title", "/blocks/0/task", "/blocks/0/means", "/blocks/0/hypotheses", "/loop/ticks"}) {
    nlohmann::json changed = report;
    changed[nlohmann::json::json_pointer{path}] = nlohmann::json::object({{"x", 1.5}});
    INFO(path);
    CHECK_FALSE(fits(changed));
  }
}
