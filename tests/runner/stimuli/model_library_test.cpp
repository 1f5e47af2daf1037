#include "runner/stimuli/model_library.hpp"

#include <catch2/catch.hpp>

#include "protocols/read_protocol.hpp"
#include "runner/stimuli/trial_stimuli.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
protocols::Protocol paper(const std::string& name) {
  return protocols::read_protocol(testing::shipped("paper/" + name).string());
}
}  // namespace

TEST_CASE("none and sinusoid build no mesh", "[runner][stimuli]") {
  protocols::Protocol protocol = paper("discrimination.yaml");
  for (const char* technique : {"none", "sinusoid"}) {
    for (protocols::Stimulus& stimulus : protocol.stimuli) {
      stimulus.technique = core::find_technique(technique);
    }
    runner::ModelLibrary models{core::ModelCache{"", ""}};
    models.build_all(protocol);
    runner::build_trial_stimuli(protocol, {protocol.stimuli.front().name}, models);
    CHECK(models.bodies_solved() == 0);
    CHECK(models.bodies_used() == 0);
  }
}

TEST_CASE("materials of one Poisson's ratio share one solution", "[runner][stimuli]") {
  protocols::Protocol protocol = paper("discrimination.yaml");
  for (protocols::Stimulus& stimulus : protocol.stimuli) {
    protocols::Material material = *stimulus.material;
    material.poissons_ratio = 0.3;
    stimulus.material = std::make_shared<const protocols::Material>(material);
  }
  runner::ModelLibrary models{core::ModelCache{"", ""}};
  models.build_all(protocol);
  CHECK(models.bodies_solved() == 2);  // four stimuli, two plates
}

TEST_CASE("a second library finds on disk what the first has solved", "[runner][stimuli]") {
  const testing::TempDirectory directory;
  const protocols::Protocol protocol = paper("discrimination.yaml");
  runner::ModelLibrary first{core::ModelCache{directory / "models", "1"}};
  first.build_all(protocol);
  CHECK(first.bodies_solved() == 4);
  runner::ModelLibrary second{core::ModelCache{directory / "models", "1"}};
  second.build_all(protocol);
  CHECK(second.bodies_solved() == 0);
  CHECK(second.bodies_used() == 4);
}

TEST_CASE("a body that does not vibrate in the band is refused, with its first frequency",
          "[runner][stimuli]") {
  const protocols::Protocol protocol = protocols::parse_protocol(
      testing::replaced(testing::contents(testing::shipped("paper/discrimination.yaml")),
                        "band_limit_hz: 300", "band_limit_hz: 20"),
      "study.yaml");
  runner::ModelLibrary models{core::ModelCache{"", ""}};
  CHECK_THROWS_WITH(models.build_all(protocol),
                    Catch::Matchers::Contains("no mode lies below band_limit_hz (20 Hz)") &&
                        Catch::Matchers::Contains("its first is at "));
}
