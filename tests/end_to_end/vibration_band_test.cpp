#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using Catch::Matchers::Contains;

TEST_CASE("check names the modes that the device does not render, and no other", "[end_to_end]") {
  const testing::TempDirectory directory;
  const std::string protocol = testing::shipped("paper/discrimination.yaml");
  const auto modes = testing::tapstudy({"modes", protocol, "--stimulus", "acrylic_two", "--json"});
  const auto frequencies_hz =
      nlohmann::json::parse(modes.standard_output)["frequencies_hz"].get<std::vector<double>>();
  REQUIRE(frequencies_hz.size() == 3);
  const auto said_of = [&](double band_hz) {
    testing::write(
        directory / "rig.yaml",
        testing::replaced(testing::contents(testing::shipped("rigs/simulated_hand.yaml")),
                          "device:", fmt::format("vibration_band_hz: {}\ndevice:", band_hz)));
    return testing::tapstudy({"check", protocol, "--rig", directory / "rig.yaml"}).standard_output;
  };
  CHECK_THAT(said_of(0.5 * (frequencies_hz[1] + frequencies_hz[2])),
             Contains(fmt::format("acrylic_two: 1 of 3 modes are lost, at {:.0f} Hz\n",
                                  frequencies_hz[2])));
  CHECK_THAT(said_of(frequencies_hz[2] + 1.0), Contains("acrylic_two: all 3 modes\n"));
}
