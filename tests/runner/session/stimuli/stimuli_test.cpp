// Members of a family against the stimulus that a study states directly.
#include <cmath>

#include "core/error.hpp"
#include "core/model/plate_model.hpp"
#include "protocols/axes/presented_stimulus.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "runner/session/devices/rigs.hpp"
#include "runner/session/stimuli/model_library.hpp"
#include "runner/session/stimuli/stimulus_family.hpp"
#include "runner/studies/scripted_tap.hpp"
#include "support/catch.hpp"
#include "support/study_files.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using protocols::AxisValues;

namespace {
struct Edit {
  std::string from;
  std::string to;
};

struct Presented {
  protocols::PresentedStimulus stimulus;
  core::ModalModel model;
  std::vector<core::TraceSample> traces;  // of a tap at each tapping point, one after another
};

Presented presented(const protocols::Protocol& protocol, const AxisValues& asked) {
  runner::ModelLibrary models{core::ModelCache{"", ""}, core::ErrorEstimation::none};
  models.build_all(protocol);
  const int solved = models.bodies_solved();
  Presented seen{stimulus_at(protocol, protocol.stimuli.front(), asked), {}, {}};
  seen.model = models.plate_of(protocol, seen.stimulus)->model;
  for (const char* point : {"P", "Q"}) {
    const runner::ScriptedTap tap{seen.stimulus,
                                  runner::point_on_plate(point, *seen.stimulus.plate), 0.3, 0.2};
    const auto trace = runner::trace_of(tap, protocol, runner::simulated_rig(), models).ticks;
    seen.traces.insert(seen.traces.end(), trace.begin(), trace.end());
  }
  CHECK(models.bodies_solved() == solved);  // a member is neither meshed nor solved
  return seen;
}

Presented directly(std::vector<Edit> edits) {
  std::string text = testing::varied_study_text;
  for (const auto& [from, to] : edits) {
    text = testing::replaced(text, from, to);
  }
  return presented(protocols::parse_protocol(text, "study.yaml"), {});
}

// Of the largest of either, at any tick.
double largest_difference(const Presented& a, const Presented& b,
                          double (*value)(const core::TraceSample&)) {
  double difference = 0.0;
  double largest = 0.0;
  REQUIRE(a.traces.size() == b.traces.size());
  for (std::size_t i = 0; i < a.traces.size(); ++i) {
    difference = std::max(difference, std::abs(value(a.traces[i]) - value(b.traces[i])));
    largest = std::max(largest, std::abs(value(a.traces[i])));
  }
  REQUIRE(largest > 0.0);
  return difference / largest;
}

void check_equal(const Presented& member, const Presented& direct) {
  REQUIRE(member.model.frequency_hz.size() == direct.model.frequency_hz.size());
  REQUIRE(member.model.frequency_hz.size() > 0);
  CHECK((member.model.frequency_hz / direct.model.frequency_hz - 1.0).abs().maxCoeff() < 1e-10);
  CHECK((member.model.damping_ratio / direct.model.damping_ratio - 1.0).abs().maxCoeff() < 1e-9);
  constexpr double solver = 1e-6;
  CHECK(largest_difference(member, direct,
                           [](const core::TraceSample& s) { return s.vibration_n; }) < solver);
  CHECK(largest_difference(member, direct,
                           [](const core::TraceSample& s) { return s.sinusoid_n; }) < 1e-12);
  CHECK(largest_difference(member, direct, [](const core::TraceSample& s) { return s.penalty_n; }) <
        solver);
}

struct Case {
  std::vector<std::string> axes;
  AxisValues values;
  std::vector<Edit> edits;  // of the study that states the member itself
};
}  // namespace

TEST_CASE("a member is the stimulus that a study would state with its values",
          "[runner][stimuli][axes]") {
  const std::vector<std::string> elastic{"youngs_modulus_pa: {from: 0.5e9, to: 5e9, spacing: log}",
                                         "density_kg_per_m3: {from: 600, to: 4000, spacing: log}"};
  const Case one = GENERATE_COPY(values<Case>({
      {elastic, {{"youngs_modulus_pa", 0.5e9}}, {{"pa: 3.2e9", "pa: 0.5e9"}}},
      {elastic, {{"youngs_modulus_pa", 5e9}}, {{"pa: 3.2e9", "pa: 5e9"}}},
      {elastic, {{"density_kg_per_m3", 2500.0}}, {{"m3: 1180", "m3: 2500"}}},
      {elastic,
       {{"youngs_modulus_pa", 0.5e9}, {"density_kg_per_m3", 4000.0}},
       {{"pa: 3.2e9", "pa: 0.5e9"}, {"m3: 1180", "m3: 4000"}}},
      {{"damping_scale: {from: 0.5, to: 3}"},
       {{"damping_scale", 2.5}},
       {{"alpha_per_s: 60, beta_s: 8.0e-5", "alpha_per_s: 150, beta_s: 2.0e-4"}}},
      {{"penalty_stiffness_n_per_m: {from: 500, to: 4000}"},
       {{"penalty_stiffness_n_per_m", 700.0}},
       {{"penalty_stiffness_n_per_m: 2000", "penalty_stiffness_n_per_m: 700"}}},
      {{"sinusoid_amplitude_n_s_per_m: {from: 0, to: 9}"},
       {{"sinusoid_amplitude_n_s_per_m", 7.0}},
       {{"amplitude_n_s_per_m: 3", "amplitude_n_s_per_m: 7"}}},
      {{"sinusoid_decay_per_s: {from: 10, to: 900}"},
       {{"sinusoid_decay_per_s", 70.0}},
       {{"decay_per_s: 600", "decay_per_s: 70"}}},
      {{"sinusoid_frequency_hz: {from: 10, to: 400}"},
       {{"sinusoid_frequency_hz", 70.0}},
       {{"frequency_hz: 250", "frequency_hz: 70"}}},
      {{"poissons_ratio: {values: [0.1, 0.45]}", elastic[0]},
       {{"poissons_ratio", 0.4}, {"youngs_modulus_pa", 2e9}},
       {{"ratio: 0.35", "ratio: 0.45"}, {"pa: 3.2e9", "pa: 2e9"}}},
      {{"thickness_m: {values: [0.015, 0.04]}", elastic[0]},
       {{"thickness_m", 0.019}, {"youngs_modulus_pa", 0.7e9}},
       {{"0.4, 0.02]", "0.4, 0.015]"}, {"pa: 3.2e9", "pa: 0.7e9"}}},
      {{"lateral_size_m: {from: 0.6, to: 1.8, count: 3}"},
       {{"lateral_size_m", 1.3}},
       {{"size_m: [0.6, 0.4", "lateral_scale: 0.05\n    size_m: [1.2, 0.8"},
        {"at_m: [-0.25, -0.15]", "at_m: [-0.5, -0.3]"},
        {"low_m: [0.2, -0.2,", "low_m: [0.4, -0.4,"},
        {"high_m: [0.3, -0.1,", "high_m: [0.6, -0.2,"}}},
  }));
  INFO(protocols::described(one.values));
  check_equal(presented(testing::varied_study(one.axes), one.values), directly(one.edits));
}

TEST_CASE("damping stated in any way is computed for the member's own modes",
          "[runner][stimuli][axes]") {
  const auto [own, doubled] = GENERATE(values<std::pair<std::string, std::string>>({
      {"{first_ratio: 0.05, last_ratio: 0.06}", "{first_ratio: 0.1, last_ratio: 0.12}"},
      {"{measured: [{frequency_hz: 50, ratio: 0.05}, {frequency_hz: 200, ratio: 0.06}]}",
       "{measured: [{frequency_hz: 50, ratio: 0.1}, {frequency_hz: 200, ratio: 0.12}]}"},
      {"{modal_ratios: [0.02, 0.03], further_ratio: 0.01}",
       "{modal_ratios: [0.04, 0.06], further_ratio: 0.02}"},
      {"{ratio: 0.02}", "{ratio: 0.04}"},
  }));
  INFO(own);
  const std::string stated = "{alpha_per_s: 60, beta_s: 8.0e-5}";
  const std::string family = testing::replaced(
      testing::varied_study_text_with({"youngs_modulus_pa: {from: 0.5e9, to: 3e9, spacing: log}",
                                       "damping_scale: {from: 1, to: 2}"}),
      stated, own);
  const Presented member = presented(protocols::parse_protocol(family, "study.yaml"),
                                     {{"youngs_modulus_pa", 0.7e9}, {"damping_scale", 2.0}});
  check_equal(member, directly({{"pa: 3.2e9", "pa: 0.7e9"}, {stated, doubled}}));
}

TEST_CASE("natural frequencies go as the root of Young's modulus over density",
          "[runner][stimuli][axes]") {
  const auto protocol = testing::varied_study(
      {"youngs_modulus_pa: {from: 0.5e9, to: 3.2e9}", "density_kg_per_m3: {from: 1180, to: 4720}"});
  const Presented own = presented(protocol, {});
  const Presented softer = presented(protocol, {{"youngs_modulus_pa", 0.8e9}});
  const Presented denser = presented(protocol, {{"density_kg_per_m3", 4720.0}});
  const Eigen::Index modes = own.model.frequency_hz.size();
  CHECK(softer.model.frequency_hz.size() > modes);  // more of them lie in the band
  for (const Presented* half : {&softer, &denser}) {
    CHECK((half->model.frequency_hz.head(modes) / own.model.frequency_hz - 0.5).abs().maxCoeff() <
          1e-14);
  }
  CHECK((denser.model.shape.leftCols(modes) - 0.5 * own.model.shape).norm() <
        1e-14 * own.model.shape.norm());
}

TEST_CASE("the vibration's gain multiplies the vibration, and nothing else",
          "[runner][stimuli][axes]") {
  const auto protocol = testing::varied_study({"vibration_gain: {from: 0, to: 2}"});
  const Presented own = presented(protocol, {});
  for (const double gain : {0.0, 0.5, 2.0}) {
    const Presented member = presented(protocol, {{"vibration_gain", gain}});
    REQUIRE(member.traces.size() == own.traces.size());
    // until the finger, pushed differently, has moved differently
    const auto impact = std::ranges::find(own.traces, true, &core::TraceSample::impact);
    REQUIRE(impact != own.traces.end());
    const auto i = static_cast<std::size_t>(impact - own.traces.begin());
    CHECK(own.traces[i].vibration_n != 0.0);
    CHECK(member.traces[i].vibration_n == Approx(gain * own.traces[i].vibration_n).epsilon(1e-12));
    CHECK(member.traces[i].penalty_n == own.traces[i].penalty_n);
  }
}

TEST_CASE("a stimulus with rendering of its own is the member of a family that has these values",
          "[runner][stimuli][axes]") {
  const std::vector<std::pair<std::string, std::string>> stated{
      {"vibration_gain", "{from: 0, to: 3}"},
      {"sinusoid_amplitude_n_s_per_m", "{from: 0, to: 9}"},
      {"sinusoid_decay_per_s", "{from: 10, to: 900}"},
      {"sinusoid_frequency_hz", "{from: 10, to: 400}"},
      {"penalty_stiffness_n_per_m", "{from: 500, to: 4000}"}};
  const AxisValues values{{"vibration_gain", 2.5},
                          {"sinusoid_amplitude_n_s_per_m", 7.0},
                          {"sinusoid_decay_per_s", 70.0},
                          {"sinusoid_frequency_hz", 90.0},
                          {"penalty_stiffness_n_per_m", 700.0}};
  std::vector<std::string> axes;
  std::string text = testing::varied_study_text + "    rendering:\n";
  for (const auto& [axis, range] : stated) {
    axes.push_back(axis + ": " + range);
    text += "      " + axis + ": " + std::to_string(values.at(axis)) + "\n";
  }
  const Presented own = presented(protocols::parse_protocol(text, "study.yaml"), {});
  CHECK(own.stimulus.changed.empty());
  check_equal(own, presented(testing::varied_study(axes), values));
}

TEST_CASE("rendering that a stimulus cannot have of its own is refused at its line",
          "[protocols][axes]") {
  const auto refused = [](const std::string& technique, const std::string& rendering,
                          const std::string& why) {
    const std::string text =
        testing::replaced(testing::varied_study_text, "technique: fem+sinusoid",
                          "technique: " + technique + "\n    rendering: {" + rendering + "}");
    CHECK_THROWS_WITH(protocols::parse_protocol(text, "study.yaml"),
                      Contains("study.yaml:29:") && Contains(why));
  };
  refused("fem", "sinusoid_decay_per_s: 300", "technique 'fem' does not use it");
  refused("fem-coupled", "vibration_gain: 2", "technique 'fem-coupled' does not use it");
  refused("fem", "vibration_gain: -1", "vibration_gain");
  refused("fem", "youngs_modulus_pa: 1e9", "is not a known key");
}

TEST_CASE("a member that cannot be built is named with its values before the session",
          "[runner][stimuli][axes]") {
  const auto refused = [](const std::vector<std::string>& axes, const std::vector<Edit>& edits,
                          const std::string& what, const std::string& values) {
    std::string text = testing::varied_study_text_with(axes);
    for (const auto& [from, to] : edits) {
      text = testing::replaced(text, from, to);
    }
    runner::ModelLibrary models{core::ModelCache{"", ""}, core::ErrorEstimation::none};
    const auto protocol = protocols::parse_protocol(text, "study.yaml");
    CHECK_THROWS_AS(models.build_all(protocol), core::ModelError);
    CHECK_THROWS_WITH(models.build_all(protocol), Contains("study.yaml:") && Contains(what) &&
                                                      Contains("stimulus 'a' at " + values));
  };
  refused({"youngs_modulus_pa: {from: 1e9, to: 1e13}"}, {}, "no mode lies below band_limit_hz",
          "youngs_modulus_pa = 1e+13");
  refused({"thickness_m: {values: [0.01, 0.02]}"},
          {{"{region: disc, at_m: [-0.25, -0.15], radius_m: 0.02, face: both}",
            "{region: ball, at_m: [-0.3, -0.2, -0.02], radius_m: 0.005}"}},
          "touches no node", "thickness_m = 0.01");
  // own modes: listed; a softer plate has more
  refused({"youngs_modulus_pa: {from: 0.5e9, to: 4e9}"},
          {{"{alpha_per_s: 60, beta_s: 8.0e-5}", "{modal_ratios: [0.1, 0.1, 0.1]}"}},
          "materials.acrylic.damping: ", "youngs_modulus_pa = 5e+08");
  refused({"youngs_modulus_pa: {from: 1e3, to: 4e9}"}, {}, "below the band limit",
          "youngs_modulus_pa = 1000");
}

TEST_CASE("stimuli that share a plate share the body of their softest member",
          "[runner][stimuli][axes]") {
  const std::string text =
      testing::varied_study_text_with({"youngs_modulus_pa: {from: 1e9, to: 5e9}"}) +
      "  b: {plate: screwed, material: acrylic, technique: fem}\n";
  const auto protocol = protocols::parse_protocol(text, "study.yaml");
  runner::ModelLibrary models{core::ModelCache{"", ""}, core::ErrorEstimation::none};
  models.build_all(protocol);
  CHECK(models.bodies_solved() == 1);
}

TEST_CASE("a mode crosses the band limit where its frequency, as the root of E, reaches it",
          "[runner][stimuli]") {
  const auto protocol =
      testing::varied_study({"youngs_modulus_pa: {from: 1.0e9, to: 9.0e9, spacing: log}"});
  const protocols::Stimulus& stimulus = protocol.stimuli.front();
  const auto range = std::ranges::find(stimulus.vary, std::string_view{"youngs_modulus_pa"},
                                       [](const auto& axis) { return axis.axis->name; });
  REQUIRE(range != stimulus.vary.end());
  runner::ModelLibrary models{core::ModelCache{"", ""}, core::ErrorEstimation::none};
  models.build_all(protocol);
  const auto softest = stimulus_at(protocol, stimulus, {{"youngs_modulus_pa", range->from}});
  std::vector<double> crossings_pa;
  const auto plate = models.plate_of(protocol, softest);  // a member is not kept
  for (const double frequency_hz : plate->model.frequency_hz) {
    const double youngs_modulus_pa =
        range->from * std::pow(protocol.band_limit_hz / frequency_hz, 2);
    if (youngs_modulus_pa < range->to) {
      crossings_pa.push_back(youngs_modulus_pa);
    }
  }
  std::ranges::sort(crossings_pa);
  REQUIRE(!crossings_pa.empty());
  const auto found = runner::band_crossings(
      protocol, stimulus, *range, *models.body_of(protocol, stimulus_with(protocol, stimulus)));
  REQUIRE(found.size() == crossings_pa.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CHECK(found[i] == Approx(crossings_pa[i]).epsilon(1e-9));
  }
}

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
    runner::ModelLibrary models{core::ModelCache{"", ""}, core::ErrorEstimation::none};
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
  runner::ModelLibrary models{core::ModelCache{"", ""}, core::ErrorEstimation::none};
  models.build_all(protocol);
  CHECK(models.bodies_solved() == 2);  // four stimuli, two plates
}

TEST_CASE("an orthotropic material shares no solution with an isotropic one", "[runner][stimuli]") {
  protocols::Protocol protocol = paper("discrimination.yaml");
  for (protocols::Stimulus& stimulus : protocol.stimuli) {
    protocols::Material material = *stimulus.material;
    material.poissons_ratio = 0.0;
    if (stimulus.name == "acrylic_two") {
      material.orthotropy = core::Orthotropy{{1.0, 1.0, 1.0}, {0.3, 0.3, 0.3}, {0.4, 0.4, 0.4}, {}};
    }
    stimulus.material = std::make_shared<const protocols::Material>(material);
  }
  runner::ModelLibrary models{core::ModelCache{"", ""}};
  models.build_all(protocol);
  CHECK(models.bodies_solved() == 3);
  const auto body = [&](const char* name) {
    return models.body_of(protocol, stimulus_with(protocol, protocol.stimulus(name)));
  };
  CHECK(body("acrylic_two") != body("mdf_two"));
  CHECK(body("acrylic_three") == body("mdf_three"));
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
  runner::ModelLibrary models{core::ModelCache{"", ""}, core::ErrorEstimation::none};
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

TEST_CASE("what damps is of a stimulus's own: materials and contacts", "[runner][stimuli][slow]") {
  const protocols::Protocol protocol =
      protocols::read_protocol(testing::shipped("examples/plate_on_feet.yaml").string());
  protocols::Stimulus stiff = protocol.stimulus("table");
  protocols::Contacts contacts = *stiff.contacts;
  for (core::JointSpring& spring : contacts.springs) {
    spring.loss_factor = 0.0;
  }
  stiff.contacts = std::make_shared<const protocols::Contacts>(contacts);
  runner::ModelLibrary models{core::ModelCache{"", ""}, core::ErrorEstimation::none};
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
  runner::ModelLibrary models{core::ModelCache{"", ""}, core::ErrorEstimation::none};
  CHECK_THROWS_WITH(
      models.build_all(protocol),
      Contains("no mode lies below band_limit_hz (20 Hz)") && Contains("its first is at "));
}
