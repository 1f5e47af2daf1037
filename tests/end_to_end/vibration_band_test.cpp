#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

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
