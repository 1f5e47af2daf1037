// --set at the command line, and families in check.
#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/varied_study.hpp"
using namespace tapstudy;

namespace {
class Study {
 public:
  Study() {
    testing::write(
        file(), testing::varied_study_text_with(
                    {"youngs_modulus_pa: {from: 1e9, to: 4e9, spacing: log}",
                     "vibration_gain: {from: 0, to: 2}", "thickness_m: {values: [0.015, 0.03]}"}));
  }
  std::string file() const { return directory_ / "study.yaml"; }
  testing::ProgramResult run(const std::string& command,
                             const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{command, file(), "--stimulus", "a"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return testing::tapstudy(arguments);
  }
  nlohmann::json modes(std::vector<std::string> more) const {
    more.emplace_back("--json");
    const auto result = run("modes", more);
    INFO(result.standard_error);
    REQUIRE(result.exit_code == 0);
    return nlohmann::json::parse(result.standard_output);
  }

 private:
  testing::TempDirectory directory_;
};
}  // namespace

TEST_CASE("modes presents the member that --set asks for, and says its values",
          "[end_to_end][axes]") {
  const Study study;
  const auto own = study.modes({});
  CHECK(own["values"] == nlohmann::json{{"youngs_modulus_pa", 3.2e9},
                                        {"vibration_gain", 1.0},
                                        {"thickness_m", 0.02}});
  const auto softer = study.modes({"--set", "youngs_modulus_pa=1.6e9"});
  CHECK(softer["values"]["youngs_modulus_pa"] == 1.6e9);
  for (std::size_t i = 0; i < own["frequencies_hz"].size(); ++i) {
    CHECK(softer["frequencies_hz"][i].get<double>() ==
          Approx(std::sqrt(0.5) * own["frequencies_hz"][i].get<double>()).epsilon(1e-9));
  }
}

TEST_CASE("the nearest value of a table is presented, said and stored as what it is",
          "[end_to_end][axes]") {
  const Study study;
  const auto result = study.run("modes", {"--json", "--set", "thickness_m=0.02"});
  CHECK_THAT(result.standard_error,
             Contains("thickness_m is presented at 0.015, the nearest value of its table to 0.02"));
  CHECK(nlohmann::json::parse(result.standard_output)["values"]["thickness_m"] == 0.015);
  CHECK(study.run("modes", {"--json", "--set", "thickness_m=0.015"}).standard_error.empty());
}

TEST_CASE("tap presents the member that --set asks for", "[end_to_end][axes]") {
  const Study study;
  const auto vibration = [&](const std::string& gain) {
    const auto result = study.run(
        "tap", {"--set", "vibration_gain=" + gain, "--at", "P", "--set", "youngs_modulus_pa=2e9"});
    INFO(result.standard_error);
    REQUIRE(result.exit_code == 0);
    CHECK_THAT(result.standard_output, Contains("youngs_modulus_pa 2000000000\n"));
    const std::string& text = result.standard_output;
    return std::stod(text.substr(text.find("vibration  ") + 9));
  };
  CHECK(vibration("0") == 0.0);
  CHECK(vibration("1") > 0.0);
}

TEST_CASE("a value that cannot be set is one clear error", "[end_to_end][axes]") {
  struct Refused {
    std::vector<std::string> more;
    const char* why;
  };
  const auto [more, why] = GENERATE(values<Refused>({
      {{"--set", "thickness=0.02"}, "is not an axis (one of: youngs_modulus_pa, density_kg_per_m3"},
      {{"--set", "thickness=0.02"}, "did you mean 'thickness_m'?"},
      {{"--set", "youngs_modulus_pa=5e9"}, "from 1000000000 to 4000000000 Pa"},
      {{"--set", "youngs_modulus_pa=nan"}, "nan is not allowed"},
      {{"--set", "youngs_modulus_pa=2e9x"}, "is not NAME=NUMBER"},
      {{"--set", "youngs_modulus_pa"}, "is not NAME=NUMBER"},
      {{"--set", "=1"}, "is not NAME=NUMBER"},
      {{"--set", ""}, "--set"},
      {{"--set", "vibration_gain=1", "--set", "vibration_gain=2"}, "is set twice"},
      {{"--set", "damping_scale=2"}, "does not vary in damping_scale"},
  }));
  const Study study;
  for (const char* command : {"tap", "modes"}) {
    const auto result = study.run(command, more);
    INFO(command << ": " << result.standard_error);
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.standard_error, Contains(why));
    CHECK(std::ranges::count(result.standard_error, '\n') == 1);
  }
}

TEST_CASE("an axis that the technique given instead does not use is refused",
          "[end_to_end][axes]") {
  const auto result = Study{}.run("tap", {"--technique", "none", "--set", "youngs_modulus_pa=2e9"});
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.standard_error, Contains("technique 'none' does not use it"));
}

TEST_CASE("check lists families with their models", "[end_to_end][axes]") {
  const Study study;
  const auto result = testing::tapstudy({"check", study.file()});
  INFO(result.standard_error);
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.standard_output,
             Contains("a: youngs_modulus_pa from 1000000000 to 4000000000 Pa; vibration_gain from "
                      "0 to 2; thickness_m 0.015, 0.03 m") &&
                 Contains("3 models, solved in "));
}

TEST_CASE("a member that cannot be built is refused at its `vary`, in one line",
          "[end_to_end][axes]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "study.yaml";
  const std::string text =
      testing::varied_study_text_with({"thickness_m: {values: [0.02, 0.0001]}"});
  testing::write(file, text);
  const auto result = testing::tapstudy({"check", file});
  INFO(result.standard_error);
  CHECK(result.exit_code == 4);
  const auto line =
      1 + std::count(text.begin(),
                     text.begin() + static_cast<std::ptrdiff_t>(text.find("thickness_m")), '\n');
  CHECK_THAT(result.standard_error, Contains("thickness_m = 0.0001"));
  const std::size_t at = result.standard_error.find(file + ":");
  REQUIRE(at != std::string::npos);
  // the mapping begins at its key or below it
  CHECK(std::abs(std::stoi(result.standard_error.substr(at + file.size() + 1)) - line) <= 1);
}
