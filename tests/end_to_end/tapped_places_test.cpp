// Where taps are said to have landed.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using testing::TempDirectory;

namespace {
// The report's part on what was rendered, of a study's simulated or pilot sessions.
nlohmann::json rendered(const std::string& study, const std::string& mode) {
  const auto run = testing::tapstudy(
      {"report", study, "--mode", mode, "--only", "rendered", "--out", study + "_r"});
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  return nlohmann::json::parse(testing::contents(study + "_r/report.json"));
}
const nlohmann::json& points_of(const nlohmann::json& report) {
  return report.at("study").at("rendered_points");
}
}  // namespace

TEST_CASE("a report files each tap under the point that was tapped on the session's own placement",
          "[end_to_end]") {
  const TempDirectory directory;
  testing::write(directory / "rig.yaml",
                 testing::contents(testing::shipped("rigs/simulated_hand.yaml")) +
                     "placement: {origin_m: [0.01, 0.005, 0], lateral_scale: 0.02}\n");
  const std::string study = directory / "study";
  const auto run = testing::tapstudy(
      {"run", testing::shipped("paper/discrimination.yaml").string(), "--rig",
       directory / "rig.yaml", "--participant", "P01", "--out", study, "--seed", "5"},
      "1\n2\n3\n4\n1\n2\n3\n4\n");
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  const auto report = rendered(study, "pilot");
  for (const auto& point : points_of(report)) {
    CAPTURE(point.dump());
    // the hand scatters by a centimetre
    CHECK((point.at("taps") == 0 || point.at("distance_m") < 0.03));
  }
}

TEST_CASE("simulated taps land on the plate that is tapped, not within the bodies it stands on",
          "[end_to_end]") {
  const TempDirectory directory;
  const std::string study = directory / "study";
  const auto run =
      testing::tapstudy({"simulate", testing::shipped("examples/plate_on_feet.yaml").string(),
                         "--participants", "1", "--seed", "1", "--out", study});
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  const auto report = rendered(study, "simulated");
  REQUIRE(points_of(report).size() == 9);  // three mountings, three points
  for (const auto& point : points_of(report)) {
    CAPTURE(point.dump());
    CHECK(point.at("taps") > 0);
  }
}
