// Plates that touch other bodies, through the program.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
std::string example() {
  return testing::shipped("examples/plate_on_feet.yaml").string();
}
nlohmann::json modes_of(const std::string& study, const std::string& stimulus) {
  const auto run = testing::tapstudy({"modes", study, "--stimulus", stimulus, "--json"});
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  return nlohmann::json::parse(run.standard_output);
}
}  // namespace

TEST_CASE(
    "a board on rubber feet vibrates lower, and is damped more, than one that is screwed down",
    "[end_to_end][contacts]") {
  const auto on_feet = modes_of(example(), "feet");
  const auto screwed = modes_of(example(), "screws");
  CHECK(on_feet.at("frequencies_hz").at(0).get<double>() <
        0.5 * screwed.at("frequencies_hz").at(0).get<double>());
  CHECK(on_feet.at("damping_ratios").at(0).get<double>() > 0.1);
  CHECK(on_feet.at("kinetic_energy_in_plate").at(0).get<double>() > 0.9);
  CHECK_FALSE(screwed.contains("kinetic_energy_in_plate"));
}

TEST_CASE("each damping of what a plate touches is a model of its own", "[end_to_end][contacts]") {
  const testing::TempDirectory directory;
  testing::write(directory / "study.yaml",
                 testing::replaced(testing::contents(example()), "damping: {ratio: 0.12}",
                                   "damping: {ratio: 0.06}"));
  const auto softer = modes_of(directory / "study.yaml", "feet");
  const auto own = modes_of(example(), "feet");
  CHECK(softer.at("frequencies_hz").at(0) == own.at("frequencies_hz").at(0));
  CHECK(softer.at("damping_ratios").at(0).get<double>() <
        0.6 * own.at("damping_ratios").at(0).get<double>());
}

TEST_CASE("a study of what a plate stands on is checked, tapped, reported and exported",
          "[end_to_end][contacts][slow]") {
  const testing::TempDirectory directory;
  CHECK(testing::tapstudy(
            {"tap", example(), "--stimulus", "table", "--at", "centre", "--speed", "0.3"})
            .exit_code == 0);
  const std::string study = directory / "study";
  REQUIRE(
      testing::tapstudy({"simulate", example(), "--participants", "2", "--out", study}).exit_code ==
      0);
  REQUIRE(testing::tapstudy({"report", study, "--out", directory / "report"}).exit_code == 0);
  CHECK_THAT(testing::contents((directory / "report") + "/report.html"),
             Contains("touches foot of 2e+06 Pa, 1100 kg/m³") && Contains("by 4 springs"));
  REQUIRE(testing::tapstudy({"export", study, "--out", directory / "csv"}).exit_code == 0);
  CHECK_THAT(testing::contents((directory / "csv") + "/stimuli.csv"),
             Contains(",board,acrylic,on_feet") && Contains(",screwed_board,acrylic,NA"));
  CHECK(testing::tapstudy({"verify", study}).exit_code == 0);
}

TEST_CASE("a material is not identified from the frequencies of several bodies",
          "[end_to_end][contacts]") {
  const testing::TempDirectory directory;
  std::string csv = "t_s,a\n";
  for (int i = 0; i < 4000; ++i) {
    const double t_s = i / 4000.0;
    const double since_s = t_s - 0.2;
    csv += fmt::format("{},{}\n", t_s,
                       since_s < 0.0 ? 0.0 : std::exp(-12.0 * since_s) * std::sin(500.0 * since_s));
  }
  testing::write(directory / "taps.csv", csv);
  const auto run = testing::tapstudy({"identify", directory / "taps.csv", "--protocol", example(),
                                      "--stimulus", "feet", "--out", directory / "identified"});
  CHECK(run.exit_code == 2);
  CHECK_THAT(run.standard_error, Contains("it touches other bodies"));
}

TEST_CASE("check names the modes that the device does not render, and no other", "[end_to_end]") {
  const testing::TempDirectory directory;
  const std::string protocol = testing::shipped("paper/discrimination.yaml");
  const auto modes = testing::tapstudy({"modes", protocol, "--stimulus", "acrylic_two", "--json"});
  const auto frequencies_hz =
      nlohmann::json::parse(modes.standard_output)["frequencies_hz"].get<std::vector<double>>();
  REQUIRE(frequencies_hz.size() == 3);
  const auto said_with = [&](const std::string& keys) {
    testing::write(
        directory / "rig.yaml",
        testing::replaced(testing::contents(testing::shipped("rigs/simulated_hand.yaml")),
                          "device:", keys + "\ndevice:"));
    return testing::tapstudy({"check", protocol, "--rig", directory / "rig.yaml"}).standard_output;
  };
  const auto said_of = [&](double band_hz) {
    return said_with(fmt::format("vibration_band_hz: {}", band_hz));
  };
  CHECK_THAT(said_of(0.5 * (frequencies_hz[1] + frequencies_hz[2])),
             Contains(fmt::format("acrylic_two: 1 of 3 modes are lost, at {:.0f} Hz\n",
                                  frequencies_hz[2])));
  CHECK_THAT(said_of(frequencies_hz[2] + 1.0), Contains("acrylic_two: all 3 modes\n"));
  // a response that is a half between the first two modes, and falls
  const double corner_hz = 0.5 * (frequencies_hz[0] + frequencies_hz[1]);
  CHECK_THAT(said_with(fmt::format("vibration_response: {{points: [{{frequency_hz: {}, gain: 1}}, "
                                   "{{frequency_hz: {}, gain: 0.25}}]}}",
                                   0.5 * corner_hz, 2.0 * corner_hz)),
             Contains("where its response is at least 0.5") &&
                 Contains(fmt::format("acrylic_two: 2 of 3 modes are lost, at {:.0f}, {:.0f} Hz\n",
                                      frequencies_hz[1], frequencies_hz[2])));
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {testing::shipped("rigs/spidar_g6.yaml").string(), "spidar_g6.yaml"},
           {testing::source("tests/data/spidar_calibration.yaml"), "spidar_calibration.yaml"}}) {
    testing::write(directory / to, testing::contents(from));
  }
  const auto board = testing::tapstudy({"check", protocol, "--rig", directory / "spidar_g6.yaml"});
  INFO(board.standard_error);
  CHECK_THAT(board.standard_output, Contains("up to 300 Hz, as the rig states none"));
}
