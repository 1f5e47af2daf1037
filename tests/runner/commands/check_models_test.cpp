#include "runner/commands/check_models.hpp"

#include <regex>

#include "core/tick/plate_vibration.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "runner/laboratory/reproduce/paper_protocols.hpp"
#include "support/blocks.hpp"
#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

TEST_CASE("the share of a finger's energy that a strike takes is what the modes have after it",
          "[runner][check]") {
  const protocols::Protocol protocol = runner::shipped_protocol("protocols/paper/plate_model.yaml");
  runner::ModelLibrary models;
  const auto stimulus = stimulus_with(protocol, protocol.stimulus("aluminium"));
  const auto plate = models.plate_of(protocol, stimulus);
  const Eigen::Vector2d at_m{0.05, -0.1};
  core::ModalState state{plate->model, core::Integrator::exact, 1e-3};
  state.touch(plate->locator->locate(at_m.x(), at_m.y()), core::Vec3::UnitZ());
  constexpr double finger_kg = 0.03;
  constexpr double speed_m_s = 0.4;
  state.strike(-finger_kg * speed_m_s);
  const double of_finger_j = 0.5 * finger_kg * speed_m_s * speed_m_s;
  CHECK(runner::impact_energy_share(*plate, at_m, finger_kg) ==
        Approx(state.energy_j() / of_finger_j).epsilon(1e-9));
}

TEST_CASE("check warns of plates that take more energy than the finger has",
          "[end_to_end][check]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "study.yaml";
  const std::string shipped = testing::contents(testing::source_directory() +
                                                "/protocols/examples/cantilever_techniques.yaml");
  testing::write(file, testing::replaced(shipped, "mass_kg: 0.02", "mass_kg: 0.2"));
  const auto heavy = testing::tapstudy({"check", file});
  CHECK_THAT(heavy.standard_output, Contains("beam is too light for the finger: struck at free"));
  testing::write(file, shipped);
  CHECK_THAT(testing::tapstudy({"check", file}).standard_output, !Contains("too light"));
}

TEST_CASE("bodies that are joined between one pair of regions are told to turn about each other",
          "[runner][check]") {
  core::JointSpring spring;
  spring.to.body = 1;
  protocols::Contacts contacts;
  contacts.springs = {spring, spring};  // in one place, along x and y, say
  protocols::PresentedStimulus stimulus;
  stimulus.name = "halves";
  CHECK(runner::note_of_hinges(stimulus).empty());
  stimulus.contacts = std::make_shared<const protocols::Contacts>(contacts);
  CHECK_THAT(runner::note_of_hinges(stimulus),
             Contains("halves has bodies") && Contains("0 and 1") && Contains("no moment"));
  contacts.springs[1].to.region.at_m.x() = 0.1;
  stimulus.contacts = std::make_shared<const protocols::Contacts>(contacts);
  CHECK(runner::note_of_hinges(stimulus).empty());
}

TEST_CASE("check warns of a plate that nothing holds", "[end_to_end][check]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "study.yaml";
  testing::write(file, R"(format: tapstudy/1
title: A loose plate
finger: {mass_kg: 0.0058, stiffness_n_per_m: 300, damping_n_s_per_m: 3}
rendering: {rate_hz: 4000, penalty_stiffness_n_per_m: 3000, band_limit_hz: 1500, integrator: exact}
placement: {origin_m: [0, 0, 0], lateral_scale: 0.2}
materials:
  steel: {youngs_modulus_pa: 2.0e11, density_kg_per_m3: 7800, poissons_ratio: 0.3, damping: {ratio: 0.01}}
plates:
  held:
    size_m: [0.2, 0.1, 0.01]
    fixations: [{region: side, side: left}]
    mesh: {order: 2}
  loose:
    size_m: [0.2, 0.1, 0.01]
    fixations: []
    mesh: {order: 2}
tapping_points_m: {P1: [0.02, 0.01]}
stimuli:
  held: {plate: held, material: steel, technique: fem-coupled}
  loose: {plate: loose, material: steel, technique: fem-coupled}
blocks:
  - {name: which, task: identification, question: Which, stimuli: [held, loose]}
)");
  const auto checked = testing::tapstudy({"check", file});
  INFO(checked.standard_error);
  CHECK_THAT(checked.standard_output, Contains("loose can move as a rigid body in 6 ways"));
  CHECK_THAT(checked.standard_output, !Contains("held can move"));
}

TEST_CASE("what a joined body states says nothing about the mesh of the plate that is tapped",
          "[runner][check]") {
  protocols::PresentedStimulus stimulus;
  stimulus.name = "cup";
  protocols::Plate tray;
  tray.stated_at = "study.yaml:9:3: plates.tray";
  tray.mesh.size.radius_edge_ratio = 3.0;
  protocols::Contacts contacts;
  contacts.plates = {nullptr, std::make_shared<const protocols::Plate>(tray)};
  contacts.bodies.emplace_back();
  contacts.bodies.back().mesh = tray.mesh;
  stimulus.contacts = std::make_shared<const protocols::Contacts>(contacts);
  core::ModelReport report;
  report.bodies = {{2, {1.414, 1.414}}, {2, {3.0, 3.0}}};
  CHECK(runner::note_of_relaxation(stimulus, report).empty());
  report.bodies[0].radius_edge_ratio.used = 2.0;
  CHECK_THAT(
      runner::note_of_relaxation(stimulus, report),
      Contains("cup is meshed with radius_edge_ratio: 2, as 1.414 takes") && !Contains("tray"));
  report.bodies = {{2, {1.414, 1.414}}, {2, {3.0, 4.0}}};
  CHECK_THAT(runner::note_of_relaxation(stimulus, report),
             Contains("body 1 that cup touches (study.yaml:9:3: plates.tray) is meshed with "
                      "radius_edge_ratio: 4, as 3 takes"));
}

TEST_CASE("check names the real plates whose models simulate builds beside those of the stimuli",
          "[end_to_end][check]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "study.yaml";
  const std::string study = testing::text_with_blocks({"test"}, "");
  const auto said = [&](const std::string& technique) {
    testing::write(file, std::regex_replace(study, std::regex{"technique: fem"}, technique));
    return testing::tapstudy({"check", file}).standard_output;
  };
  CHECK_THAT(said("technique: fem"), !Contains("`simulate` also builds"));
  CHECK_THAT(
      said("technique: none"),
      Contains("none: no technique here needs a model\n  `simulate` also builds the models of "
               "the real plates that simulated participants remember: acrylic_two, "
               "mdf_three, mdf_two\n"));
}

TEST_CASE("modes and check say along how many edges a sheet is folded: a box without a lid has 8",
          "[end_to_end][check]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "study.yaml";
  testing::write(directory / "box.off",
                 "OFF\n8 5 0\n0 0 0\n200 0 0\n200 150 0\n0 150 0\n0 0 100\n200 0 100\n"
                 "200 150 100\n0 150 100\n4 0 3 2 1\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  testing::write(directory / "sheet.off",
                 "OFF\n4 1 0\n0 0 0\n200 0 0\n200 150 0\n0 150 0\n4 0 1 2 3\n");
  testing::write(file, R"(format: tapstudy/1
title: A box
finger: {mass_kg: 0.0058, stiffness_n_per_m: 300, damping_n_s_per_m: 3}
rendering: {rate_hz: 4000, penalty_stiffness_n_per_m: 3000, band_limit_hz: 200, integrator: exact}
placement: {origin_m: [0, 0, 0], lateral_scale: 1}
materials:
  steel: {youngs_modulus_pa: 2.1e11, density_kg_per_m3: 7850, poissons_ratio: 0.3, damping: {ratio: 0.01}}
plates:
  box:
    surface: {file: box.off, metres_per_unit: 0.001, thickness_m: 0.001}
    fixations: []
  sheet:
    surface: {file: sheet.off, metres_per_unit: 0.001, thickness_m: 0.001}
    fixations: []
tapping_points_m: {middle: [0.1, 0.07]}
stimuli:
  box: {plate: box, material: steel, technique: fem-coupled}
  sheet: {plate: sheet, material: steel, technique: fem-coupled}
blocks:
  - {name: which, task: identification, question: Which, stimuli: [box, sheet]}
)");
  const std::string note = "note: box is folded along 8 edges of its triangles";
  const auto modes = testing::tapstudy({"modes", file, "--stimulus", "box"});
  INFO(modes.standard_error);
  CHECK_THAT(modes.standard_output, Contains(note));
  const std::string checked = testing::tapstudy({"check", file}).standard_output;
  CHECK_THAT(checked, Contains(note) && !Contains("sheet is folded"));
}
