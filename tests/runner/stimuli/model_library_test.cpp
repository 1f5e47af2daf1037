#include "runner/stimuli/model_library.hpp"

#include "core/model/plate_model.hpp"
#include "protocols/axes/presented_stimulus.hpp"
#include "protocols/read_protocol.hpp"
#include "runner/stimuli/trial_stimuli.hpp"
#include "support/catch.hpp"
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

TEST_CASE("on springs each Young's modulus has a solution of its own, and each density has not",
          "[runner][stimuli]") {
  protocols::Protocol protocol = paper("discrimination.yaml");
  protocols::Plate sprung = *protocol.stimuli.front().plate;
  for (core::Fixation& fixation : sprung.fixations) {
    fixation.springs_n_per_m = core::Vec3{1e5, 1e5, 1e5};
  }
  const auto plate = std::make_shared<const protocols::Plate>(sprung);
  const std::array<std::array<double, 2>, 4> properties{
      {{2e9, 600.0}, {2e9, 1200.0}, {4e9, 600.0}, {4e9, 1200.0}}};
  for (std::size_t i = 0; i < properties.size(); ++i) {
    protocols::Material material = *protocol.stimuli.at(i).material;
    material.poissons_ratio = 0.3;
    material.youngs_modulus_pa = properties.at(i).front();
    material.density_kg_per_m3 = properties.at(i).back();
    protocol.stimuli.at(i).material = std::make_shared<const protocols::Material>(material);
    protocol.stimuli.at(i).plate = plate;
  }
  runner::ModelLibrary models{core::ModelCache{"", ""}};
  models.build_all(protocol);
  CHECK(models.bodies_solved() == 2);
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    const Eigen::ArrayXd alone_hz =
        core::build_plate_model({*plate, *stimulus.material, protocol.band_limit_hz})
            .modal.frequency_hz;
    const auto presented = protocols::stimulus_at(protocol, stimulus, {});
    CHECK(models.plate_of(protocol, presented)->model.frequency_hz.isApprox(alone_hz, 1e-8));
  }
}

TEST_CASE("what damps is of a stimulus's own: materials and contacts", "[runner][stimuli]") {
  const protocols::Protocol protocol =
      protocols::read_protocol(testing::shipped("examples/plate_on_feet.yaml").string());
  protocols::Stimulus stiff = protocol.stimulus("table");
  protocols::Contacts contacts = *stiff.contacts;
  for (core::ContactSpring& spring : contacts.springs) {
    spring.loss_factor = 0.0;
  }
  stiff.contacts = std::make_shared<const protocols::Contacts>(contacts);
  runner::ModelLibrary models{core::ModelCache{"", ""}};
  const auto ratios = [&](const protocols::Stimulus& stimulus) {
    return models.plate_of(protocol, protocols::stimulus_with(protocol, stimulus))
        ->model.damping_ratio;
  };
  CHECK((ratios(stiff) < ratios(protocol.stimulus("table"))).any());
  CHECK(models.bodies_solved() == 1);
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
  CHECK_THROWS_WITH(
      models.build_all(protocol),
      Contains("no mode lies below band_limit_hz (20 Hz)") && Contains("its first is at "));
}
