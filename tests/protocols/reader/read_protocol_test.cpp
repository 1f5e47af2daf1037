#include "protocols/reader/read_protocol.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "core/error.hpp"
#include "protocols/form.hpp"
#include "protocols/reader/earlier_defaults.hpp"
#include "support/catch.hpp"
#include "support/study_files.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using testing::replaced;

namespace {
std::string refusal(const std::string& text) {
  try {
    protocols::parse_protocol(text, "study.yaml");
  } catch (const core::InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}
std::string discrimination() {
  return testing::contents(testing::shipped("paper/discrimination.yaml"));
}
}  // namespace

TEST_CASE("a comma where a document should begin is no endless row of documents", "[protocols]") {
  const std::string text = discrimination();
  CHECK(refusal(",,," + text) != "accepted");
  CHECK(refusal(replaced(text, "finger:", ",finger:")) != "accepted");
  CHECK_THAT(refusal(text + "---\ntitle: another\n"), Contains("more than one YAML document"));
}

TEST_CASE("settings of a mesh are of tetrahedra, cubic ones flatter than others, or of shells",
          "[protocols]") {
  const auto with = [](const std::string& mesh) {
    return refusal(replaced(testing::contents(testing::shipped("examples/stiffness_jnd.yaml")),
                            "mesh: {order: 2, max_tet_volume_m3: 2.2e-5}", "mesh: " + mesh));
  };
  CHECK(with("{order: 3, flattening: 40}") == "accepted");
  CHECK(with("{order: 2, flattening: 20}") == "accepted");
  CHECK_THAT(with("{order: 2, flattening: 40}"), Contains("flattening: beyond 20 is of order 3"));
  CHECK_THAT(with("{flattening: 40}"), Contains("flattening: beyond 20 is of order 3"));
  CHECK(with("{shell_width_m: 0.1}") == "accepted");
  CHECK_THAT(with("{shell_width_m: 0.1, order: 2}"), Contains("order: is of tetrahedra"));
}

TEST_CASE("whole numbers are read as YAML 1.2 has them", "[protocols]") {
  const auto repetitions = [](const std::string& number) {
    return protocols::parse_protocol(
               replaced(discrimination(), "repetitions: 2", "repetitions: " + number), "study.yaml")
        .blocks.front()
        .repetitions;
  };
  CHECK(repetitions("010") == 10);
  CHECK(repetitions("0o10") == 8);
  CHECK(repetitions("0x10") == 16);
  CHECK(repetitions("+10") == 10);
  for (const char* const none : {"08x", "1_000", "0b10", "1e1", "--1", "+-1", "0x-1"}) {
    CHECK_THAT(
        refusal(replaced(discrimination(), "repetitions: 2", std::string{"repetitions: "} + none)),
        Contains(fmt::format("'{}' is not a whole number", none)));
  }
  CHECK_THAT(refusal(replaced(discrimination(), "repetitions: 2", "repetitions: 5000000000")),
             Contains("5000000000 is not allowed"));
  CHECK(protocols::parse_protocol(replaced(discrimination(), "rate_hz: 1000", "rate_hz: 01750"),
                                  "study.yaml")
            .rate_hz == 1750.0);
}

TEST_CASE("a plate that states no element order has that of the study's time, or its own choice",
          "[protocols][model]") {
  const auto order = [](const std::string& mesh, const protocols::EarlierDefaults& defaults) {
    const std::string text = replaced(discrimination(), "    mesh: {order: 1}\n", mesh);
    return protocols::parse_protocol(protocols::StudyText{text, "study.yaml"}, {}, defaults)
        .plates.at("two_fixations")
        ->mesh.order;
  };
  CHECK(order("", {}) == core::chosen_order);
  CHECK(order("    mesh: {accuracy: 0.1}\n", {}) == core::chosen_order);
  CHECK(order("", {1}) == 1);
  CHECK(order("    mesh: {accuracy: 0.1}\n", {1}) == 1);
  CHECK(order("    mesh: {order: 2}\n", {1}) == 2);
  CHECK(order("    mesh: {order: 1}\n", {}) == 1);
}

TEST_CASE("the paper's own studies keep linear elements", "[protocols]") {
  int plates = 0;
  for (const auto& entry : std::filesystem::directory_iterator{testing::shipped("paper")}) {
    if (entry.path().extension() != ".yaml") {
      continue;
    }
    for (const auto& [name, plate] : protocols::read_protocol(entry.path().string()).plates) {
      INFO(entry.path() << ", " << name);
      CHECK(plate->mesh.order == 1);
      ++plates;
    }
  }
  CHECK(plates >= 7);
}

TEST_CASE("columns in messages count characters", "[protocols]") {
  // the question's characters take one, two and three bytes
  const auto column = [](const std::string& question) {
    const std::string text = refusal("title: \"" + question + "\" x\n");
    return text.substr(0, text.find(": not YAML"));
  };
  CHECK(column("aaaa") == column("aé板a"));
  const auto at = [](const std::string& title) {
    const std::string text = refusal("{title: " + title + ", nothing_known: 1}");
    return text.substr(0, text.find("nothing_known"));
  };
  CHECK(at("aaa") == at("é板a"));
}

TEST_CASE("every shipped protocol can be read", "[protocols]") {
  for (const char* const folder : {"paper", "recommended", "examples"}) {
    for (const auto& entry : std::filesystem::directory_iterator{testing::shipped(folder)}) {
      if (entry.path().extension() == ".yaml") {
        INFO(entry.path().string());
        CHECK_NOTHROW(protocols::read_protocol(entry.path().string()));
      }
    }
  }
}

TEST_CASE("a break comes after trials or time, and may last so long as it must", "[protocols]") {
  const auto with_breaks = [](const std::string& breaks) {
    return refusal(replaced(discrimination(), "    task: identification\n",
                            "    task: identification\n    breaks: {" + breaks + "}\n"));
  };
  CHECK(with_breaks("every_seconds: 600, max_seconds: 30") == "accepted");
  CHECK_THAT(with_breaks("min_seconds: 30"), Contains("breaks.every_trials: is missing"));
  CHECK_THAT(with_breaks("every_trials: 4, min_seconds: 30, max_seconds: 20"),
             Contains("breaks.max_seconds: is below min_seconds"));
}

TEST_CASE("no claim is tested of a block whose procedures estimate a threshold", "[protocols]") {
  const std::string text = testing::contents(testing::source("tests/data/every_task.yaml"));
  const auto with_claim_of = [&](const std::string& block) {
    return refusal(text + "\nhypotheses: [{name: h, statement: It is felt., block: " + block +
                   ", claim: accuracy_above_chance}]\n");
  };
  CHECK(with_claim_of("abx") == "accepted");
  CHECK_THAT(with_claim_of("comparison"),
             Contains("hypotheses[0].block: has procedures: its threshold is estimated"));
}

TEST_CASE("a sinusoid by place leads from one place to another, and does not alias at either",
          "[protocols]") {
  const auto with = [](const std::string& by_place) {
    return refusal(replaced(discrimination(), "  penalty_stiffness_n_per_m:",
                            "  sinusoid: {amplitude_n_s_per_m: 3, frequency_hz: 300, by_place: {" +
                                by_place + "}}\n  penalty_stiffness_n_per_m:"));
  };
  CHECK(with("from_m: [0, 0], to_m: [0.1, 0], frequency_factor: 1.5") == "accepted");
  CHECK_THAT(with("from_m: [0, 0], to_m: [0, 0]"),
             Contains("by_place.to_m: is the same as from_m"));
  CHECK_THAT(with("from_m: [0, 0], to_m: [0.1, 0], frequency_factor: 2"),
             Contains("rendering.sinusoid: its frequency is not below half of rate_hz"));
}

TEST_CASE("levels as responses are refused with the factor that is to be named", "[protocols]") {
  const std::string text = replaced(discrimination(), "    task: identification\n",
                                    "    task: identification\n    responses: [acrylic, mdf]\n");
  CHECK_THAT(refusal(text),
             Contains("responses: 'acrylic' is a level of the factor 'material': add "
                      "response_factor: material"));
  CHECK_THAT(refusal(text), !Contains("cannot be answered"));
}

TEST_CASE("an unknown key is refused with its place and the key that was meant", "[protocols]") {
  const std::string text =
      replaced(discrimination(), "  penalty_stiffness_n_per_m:", "  penalty_stifness_n_per_m:");
  CHECK_THAT(refusal(text), Contains("study.yaml:21:3: rendering.penalty_stifness_n_per_m: is not "
                                     "a known key"));
  CHECK_THAT(refusal(text), Contains("did you mean 'penalty_stiffness_n_per_m'?"));
  CHECK_THAT(refusal(text), !Contains("is missing"));
}

TEST_CASE("all that is wrong is said at once, in the order of the file", "[protocols]") {
  std::string text = replaced(discrimination(), "mass_kg: 0.058", "mass_kg: heavy");
  text = replaced(text, "poissons_ratio: 0.35", "poissons_ratio: 0.5");
  text = replaced(text, "plate: two_fixations", "plate: two_fixation");
  const std::string said = refusal(text);
  CHECK_THAT(said, Contains("finger.mass_kg: 'heavy' is not a number"));
  CHECK_THAT(said, Contains("materials.acrylic.poissons_ratio: 0.5 is not allowed (greater than -1 "
                            "and less than 0.5)"));
  CHECK_THAT(said, Contains("stimuli.acrylic_two.plate: 'two_fixation' is not a known plate"));
  CHECK(said.find("mass_kg") < said.find("poissons_ratio"));
  CHECK(said.find("poissons_ratio") < said.find("two_fixation"));
}

TEST_CASE("an orthotropic material is read, and refused at its line by the inequality that fails",
          "[protocols]") {
  const auto with = [](const std::string& ratios) {
    return replaced(replaced(discrimination(), "youngs_modulus_pa: 3.2e9",
                             "youngs_moduli_pa: [4.0e9, 1.0e9, 2.0e9]\n"
                             "    shear_moduli_pa: [8.0e8, 4.0e8, 2.0e8]\n"
                             "    axes_rotation_rad: [0, 0, 1.5]"),
                    "poissons_ratio: 0.35", "poissons_ratios: " + ratios);
  };
  const protocols::Protocol protocol =
      protocols::parse_protocol(with("[0.3, 0.2, 0.1]"), "study.yaml");
  const protocols::Material& acrylic = *protocol.stimulus("acrylic_two").material;
  CHECK(acrylic.youngs_modulus_pa == 4e9);
  REQUIRE(acrylic.orthotropy);
  CHECK(*acrylic.orthotropy ==
        core::Orthotropy{{1.0, 0.25, 0.5}, {0.3, 0.2, 0.1}, {0.2, 0.1, 0.05}, {0.0, 0.0, 1.5}});
  CHECK_FALSE(protocol.stimulus("mdf_two").material->orthotropy);
  CHECK_THAT(refusal(with("[2.5, 0.2, 0.1]")),
             Contains("materials.acrylic.poissons_ratios: |nu_12| = 2.5 is not less than "
                      "sqrt(E_1 / E_2) = 2"));
}

TEST_CASE("an orthotropic material is for no beam, and its Poisson's ratio does not vary",
          "[protocols]") {
  const auto orthotropic = [](const std::string& text) {
    return replaced(replaced(text, "youngs_modulus_pa: 3.2e9",
                             "youngs_moduli_pa: [4.0e9, 1.0e9, 2.0e9]\n"
                             "    shear_moduli_pa: [8.0e8, 4.0e8, 2.0e8]"),
                    "poissons_ratio: 0.35", "poissons_ratios: [0.3, 0.2, 0.1]");
  };
  const auto varied = [&](const std::string& axis) {
    return orthotropic(testing::varied_study_text_with({axis}));
  };
  CHECK_THAT(refusal(varied("poissons_ratio: {values: [0.2, 0.3]}")),
             Contains("vary.poissons_ratio: an orthotropic material has three of them"));
  CHECK_NOTHROW(
      protocols::parse_protocol(varied("youngs_modulus_pa: {from: 2e9, to: 8e9}"), "study.yaml"));
  const std::string wooden =
      orthotropic(testing::contents(testing::shipped("examples/cantilever_techniques.yaml")));
  CHECK_THAT(refusal(wooden), Contains("a beam in closed form is isotropic"));
}

TEST_CASE("a plate with a scale of its own is tapped at the same places of the device",
          "[protocols]") {
  const std::string plate = "  two_fixations:\n    size_m: [0.6, 0.6, 0.05]\n";
  const std::string larger =
      "  two_fixations:\n    size_m: [1.2, 1.2, 0.05]\n    lateral_scale: 0.05\n";
  const auto read = [&](const std::string& plate_text) {
    return protocols::parse_protocol(
        replaced(
            replaced(replaced(discrimination(), plate, plate_text), "[-0.3, -0.3]", "[-0.6, -0.6]"),
            "[0.3, -0.3]", "[0.6, -0.6]"),
        "study.yaml");
  };
  const protocols::Protocol protocol = read(larger);
  const protocols::Plate& own = *protocol.plates.at("two_fixations");
  for (const auto& [name, at_m] : protocol.tapping_points_m) {
    const core::Vec3 usual = protocol.placement.point_to_device({at_m.x(), at_m.y(), 0.0});
    const Eigen::Vector2d own_m = own.tapping_points_m.at(name);
    CHECK(own_m.isApprox(2.0 * at_m));
    CHECK(protocol.placement.scaled(own.lateral_ratio)
              .point_to_device({own_m.x(), own_m.y(), 0.0})
              .isApprox(usual));
  }
  const std::string elsewhere = larger + "    tapping_points_m: {P1: [0.1, 0.1]}\n";
  CHECK_THROWS_WITH(read(elsewhere), Contains("must not be distinguishable by where"));
  const std::string unknown = larger + "    tapping_points_m: {P9: [0.1, 0.1]}\n";
  CHECK_THROWS_WITH(read(unknown), Contains("'P9' is not among the study's tapping points"));
}

TEST_CASE("what makes no sense as a study is refused", "[protocols]") {
  struct Case {
    const char* from;
    const char* to;
    const char* said;
  };
  const auto [from, to, said] = GENERATE(values<Case>({
      {"rate_hz: 1000", "rate_hz: .nan", "rendering.rate_hz: nan is not allowed"},
      {"rate_hz: 1000", "rate_hz: 1e999", "rendering.rate_hz"},
      {"rate_hz: 1000", "rate_hz: 500", "rendering.band_limit_hz: is not below half of rate_hz"},
      {"band_limit_hz: 300", "band_limit_hz: 900\n  crossover_hz: [280, 200]",
       "rendering.crossover_hz: does not ascend"},
      {"band_limit_hz: 300", "band_limit_hz: 900\n  crossover_hz: [200, 500]",
       "rendering.crossover_hz: does not end below half of rate_hz"},
      {"repetitions: 2", "repetitions: 0", "blocks[0].repetitions: 0 is not allowed"},
      {"repetitions: 2", "repetitions: 2.5", "blocks[0].repetitions: '2.5' is not a whole number"},
      {"size_m: [0.6, 0.6, 0.05]", "size_m: [0.6, 0.6]", "is not a list of 3 numbers"},
      {"size_m: [0.6, 0.6, 0.05]", "size_m: [0.6, -1, 0.05]", "size_m[1]: -1 is not allowed"},
      {"factors: {structure: two, material: mdf}", "factors: {structure: two}",
       "stimuli.mdf_two.factors: are not those of stimulus 'acrylic_two'"},
      {"technique: fem", "technique: fem+sinusoid", "needs rendering.sinusoid"},
      {"technique: fem", "technique: fern", "did you mean 'fem'?"},
      {"stimuli: [acrylic_two, mdf_two,", "stimuli: [acrylic_two, acrylic_two,",
       "blocks[0].stimuli[1]: 'acrylic_two' is listed twice"},
      {"claim: accuracy_above_chance", "claim: chosen_above_chance", "does not fit the task"},
      {"title: Structure", "title: A\ntitle: Structure", "title: is there twice"},
      {"format: tapstudy/1", "format: tapstudy/9", "'tapstudy/9' is not a known format"},
      {"blocks:\n  - name", "blocks:\n  name", "indented like its neighbours?"},
      {"finger:\n  mass", "finger:\n\tmass", "is indented with a tab: use spaces"},
      {"title: Structure", "title: \"Structure", "is the quote in line"},
      {"size_m: [0.6, 0.6, 0.05]", "size_m: [0,6, 0,6, 0,05]", "it has 6 (decimals take a point)"},
      {"damping: {alpha_per_s: 120.0, beta_s: 7.05e-5}",
       "damping: {measured: [{frequency_hz: 90, ratio: 0.02}, {frequency_hz: 90, ratio: 0.03}]}",
       "damping.measured: has one frequency only"},
      {"finger:\n", "finger: soft\nfinger2:\n", "finger: 'soft' is not a mapping"},
  }));
  INFO(from << " → " << to);
  CHECK_THAT(refusal(replaced(discrimination(), from, to)), Contains(said));
}

TEST_CASE(
    "with a crossover modes beyond the loop's rate are an actuator's, but not a coupled finger's",
    "[protocols][actuator]") {
  const std::string divided = replaced(discrimination(), "band_limit_hz: 300",
                                       "band_limit_hz: 2000\n  crossover_hz: [200, 300]");
  CHECK(refusal(divided) == "accepted");
  CHECK_THAT(refusal(replaced(divided, "technique: fem", "technique: fem-coupled")),
             Contains("needs rendering without crossover_hz"));
}

TEST_CASE("an interaction and an equivalence are refused where nothing could be tested",
          "[protocols]") {
  const std::string text =
      replaced(discrimination(), "claim: accuracy_above_chance", "claim: CLAIM");
  const auto with_claim = [&](const std::string& claim) {
    return refusal(replaced(text, "claim: CLAIM", "claim: " + claim));
  };
  CHECK(with_claim("interaction\n    factors: [structure, material]") == "accepted");
  CHECK(with_claim("equivalent\n    stimulus: mdf_two\n    to: mdf_three\n    within: 0.1") ==
        "accepted");
  CHECK_THAT(with_claim("interaction\n    factors: [structure]"),
             Contains("hypotheses[0].factors: an interaction is of two factors"));
  CHECK_THAT(with_claim("equivalent\n    stimulus: mdf_two\n    to: mdf_two\n    within: 0.1"),
             Contains("hypotheses[0].to: is the stimulus itself"));
  CHECK_THAT(with_claim("threshold_below\n    below: 0.1"),
             Contains("hypotheses[0].block: has no threshold"));
  CHECK_THAT(with_claim("equivalent\n    to_block: other\n    to: mdf_two\n    within: 0.1"),
             Contains("hypotheses[0].to: is not read beside the other keys given") &&
                 !Contains("did you mean"));
  CHECK_THAT(with_claim("equivalent\n    to_block: nowhere\n    within: 0.1"),
             Contains("hypotheses[0].to_block: 'nowhere'"));
  const std::string block = text.substr(text.find("stimuli: [acrylic_two"));
  CHECK_THAT(refusal(replaced(replaced(text, "claim: CLAIM",
                                       "claim: interaction\n    factors: [structure, material]"),
                              "stimuli: [acrylic_two, mdf_two, acrylic_three, mdf_three]",
                              "stimuli: [acrylic_two, mdf_two, acrylic_three]")),
             Contains("hypotheses[0].factors: the block's stimuli are not all combinations"));
}

TEST_CASE("a hypothesis about a level beyond those presented, or of an earlier's name, is refused",
          "[protocols]") {
  const auto with = [](const std::string& names, double below) {
    std::string text = testing::contents(testing::shipped("examples/stiffness_jnd.yaml"));
    text += "hypotheses:\n";
    for (const char name : names) {
      text += fmt::format(
          "  - {{name: {}, statement: S., block: stiffness, claim: threshold_below, below: {}}}\n",
          name, below);
    }
    return refusal(text);
  };
  CHECK(with("ab", 0.5) == "accepted");
  CHECK_THAT(with("aba", 0.5), Contains("hypotheses[2].name: 'a' is the name of an earlier one"));
  CHECK_THAT(with("a", 3.5), Contains("hypotheses[0].below: 3.5 is not between the levels") &&
                                 Contains("0.05 to 3"));
}

TEST_CASE("a coupled finger without a mass, or not held to the hand, is one error at its line",
          "[protocols][coupled]") {
  const std::string coupled =
      replaced(discrimination(), "technique: fem", "technique: fem-coupled");
  CHECK_NOTHROW(protocols::parse_protocol(coupled, "study.yaml"));
  const auto line_of = [](const std::string& text, const std::string& key) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(text.find(key));
    return 1 + std::count(text.begin(), end, '\n');
  };
  const auto only_error = [&](const std::string& text, const std::string& key) {
    const std::string said = refusal(text);
    CHECK(std::count(said.begin(), said.end(), '\n') == 0);
    CHECK_THAT(said,
               Catch::Matchers::StartsWith(fmt::format("study.yaml:{}:", line_of(text, key))));
    return said;
  };
  CHECK_THAT(only_error(replaced(coupled, "  mass_kg: 0.058", "  # no mass"), "stiffness_n_per_m"),
             Contains("finger.mass_kg: is missing"));
  CHECK_THAT(only_error(replaced(coupled, "mass_kg: 0.058", "mass_kg: 0"), "mass_kg"),
             Contains("finger.mass_kg: 0 is not allowed"));
  CHECK_THAT(only_error(replaced(coupled, "stiffness_n_per_m: 300", "stiffness_n_per_m: 0"),
                        "technique: fem-coupled"),
             Contains("'fem-coupled' needs finger.stiffness_n_per_m above 0"));
}

TEST_CASE("a file that is not there, empty or no text is refused", "[protocols]") {
  CHECK_THROWS_AS(protocols::read_protocol("/nowhere/study.yaml"), core::InvalidInput);
  CHECK_THROWS_AS(protocols::read_protocol("/tmp"), core::InvalidInput);
  CHECK_THAT(refusal(""), Contains("study.yaml:1:1"));
  CHECK_THAT(refusal("[1, 2]"), Contains("study.yaml:1:1"));
  CHECK_THAT(refusal("{a: b"), Contains("not YAML"));
  CHECK_THAT(refusal(std::string{"\0\1\2\xff", 4}), Contains("study.yaml"));
}

TEST_CASE("the text that is stored is the file's, and surfaces are beside it whole",
          "[protocols]") {
  const std::string file = testing::source("tests/data/every_key.yaml");
  const protocols::Protocol protocol = protocols::read_protocol(file);
  CHECK(protocol.text == testing::contents(file));
  REQUIRE(protocol.surfaces.size() == 2);  // the second is the first as repaired
  CHECK(protocol.surfaces.front().file == "tetrahedron.off");
  CHECK(protocol.surfaces.front().bytes ==
        testing::contents(testing::source("tests/data/tetrahedron.off")));
  REQUIRE(protocol.pictures.size() == 1);  // shown in six places
  CHECK(*protocol.pictures.front().bytes ==
        testing::contents(testing::source("tests/data/plates.svg")));
}

TEST_CASE("a picture that is refused is one error at its file's key", "[protocols][forms]") {
  const auto [from, to, said] = GENERATE(table<std::string, std::string, std::string>({
      {"picture: {file: plates.svg, text: The plates}",
       "picture: {file: gone.svg, text: The plates}", "forms.about.picture.file: "},
      {"picture: {file: plates.svg, text: The plates}",
       "picture: {file: every_key.yaml, text: The plates}", "it holds none of these"},
      {", {file: plates.svg, text: A right hand}", "", "option_pictures: 1 are given (must be 2"},
      {"    instructions: First some practice.\n", "", "instructions_picture: stands beside"},
  }));
  INFO(from << " → " << to);
  const std::string file = testing::source("tests/data/every_key.yaml");
  const std::string text = testing::replaced(testing::contents(file), from, to);
  CHECK_THROWS_WITH(protocols::parse_protocol(text, file),
                    Contains(said) && !Contains("\n") && Contains(file + ":"));
}

TEST_CASE("stimuli of one plate share it, and so do those of one material", "[protocols]") {
  const protocols::Protocol protocol = protocols::parse_protocol(discrimination(), "study.yaml");
  CHECK(protocol.stimulus("mdf_two").plate == protocol.stimulus("acrylic_two").plate);
  CHECK(protocol.stimulus("mdf_two").material == protocol.stimulus("mdf_three").material);
  CHECK(protocol.stimulus("mdf_two").plate != protocol.stimulus("mdf_three").plate);
}

TEST_CASE("the edges of masking noise are in order, and for a band only", "[protocols]") {
  const auto with = [](const std::string& masking) {
    return refusal(discrimination() + "masking: {" + masking + ", level_db_fs: -30}\n");
  };
  CHECK_THAT(with("kind: band, band_hz: [1000, 100]"),
             Contains("masking.band_hz: its edges are not in order"));
  CHECK_THAT(with("kind: pink, band_hz: [100, 1000]"),
             Contains("masking.band_hz: is for kind: band only"));
  CHECK_THAT(with("kind: band"), Contains("masking.band_hz: is missing"));
}

// What plates touch, as it is read.
namespace {
std::string on_feet() {
  return testing::contents(testing::shipped("examples/plate_on_feet.yaml"));
}
std::string refusal(const std::string& from, const std::string& to) {
  try {
    protocols::parse_protocol(testing::replaced(on_feet(), from, to), "study.yaml");
  } catch (const core::InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}
const protocols::Stimulus& stimulus(const protocols::Protocol& protocol, const char* name) {
  return protocol.stimulus(name);
}
}  // namespace

TEST_CASE("a stimulus touches what its contacts say, each spring between the named regions",
          "[protocols][contacts]") {
  const protocols::Protocol protocol = protocols::parse_protocol(on_feet(), "study.yaml");
  const protocols::Contacts& feet = *stimulus(protocol, "feet").contacts;
  REQUIRE(feet.bodies.size() == 4);
  CHECK(feet.bodies[2].material.youngs_modulus_pa == 2.0e6);
  REQUIRE(feet.springs.size() == 4);
  CHECK(feet.springs[1].from.body == 0);
  CHECK(feet.springs[1].from.region.at_m.x() == 0.12);
  CHECK(feet.springs[1].to.body == 2);
  CHECK(feet.springs[1].to.region.side == core::Side::top);
  CHECK(feet.springs[1].stiffness_n_per_m == core::Vec3{1e6, 1e6, 1e7});
  CHECK(stimulus(protocol, "table").contacts->springs[0].loss_factor == 0.3);
  CHECK(stimulus(protocol, "screws").contacts == nullptr);
}

TEST_CASE("contacts that cannot be are refused where they are stated", "[protocols][contacts]") {
  const std::string first = "from: board.front_left, to: foot_1.top";
  CHECK_THAT(refusal("to: foot_1.top", "to: foot_1.tip"),
             Contains("study.yaml:") && Contains("contacts.on_feet.springs[0].to: 'foot_1.tip'") &&
                 Contains("did you mean 'foot_1.top'?") && !Contains("lead from"));
  CHECK_THAT(refusal(first, "from: foot_2.top, to: foot_2.top"),
             Contains("springs[0].to: is a point of the same body as from"));
  CHECK_THAT(refusal(first, "from: board.front_left"), Contains("springs[0].to: is missing"));
  CHECK_THAT(refusal(first, "from: board.front_left, to: foot_2.top"),
             Contains("contacts.on_feet.bodies: no springs lead from 'foot_1' to the plate"));
  CHECK_THAT(refusal("foot_1.top, springs_n_per_m: [1.0e6, 1.0e6, 1.0e7]",
                     "foot_1.top, springs_n_per_m: [1.0e6, -1.0e6, 1.0e7]"),
             Contains("springs[0].springs_n_per_m"));
  CHECK_THAT(refusal("foot_1.top, springs_n_per_m: [1.0e6, 1.0e6, 1.0e7]",
                     "foot_1.top, springs_n_per_m: [0, 0, 0]"),
             Contains("joins nothing: every stiffness is 0"));
  CHECK_THAT(refusal("foot_1: {plate", "board: {plate"),
             Contains("has the name of the plate that is tapped"));
  CHECK_THAT(refusal("{label: screws, plate: screwed_board, material: acrylic, technique: fem}",
                     "{label: screws, plate: screwed_board, material: acrylic, technique: fem, "
                     "contacts: on_feet}"),
             Contains("stimuli.screws.contacts: are those of plate 'board'"));
  CHECK_THAT(refusal("technique: fem, contacts: on_feet}", "technique: fem, contacts: on_foot}"),
             Contains("did you mean 'on_feet'?"));
  CHECK_THAT(refusal("max_tet_volume_m3: 5.0e-7}", "accuracy: 0.01}"),
             Contains("its mesh has an accuracy"));
  CHECK_THAT(
      refusal("damping: {ratio: 0.12}", "damping: {modal_ratios: [0.1], further_ratio: 0.1}"),
      Contains("bodies.foot_1.material: its modal_ratios are of a plate's own modes"));
  CHECK_THAT(refusal("contacts: on_feet}",
                     "contacts: on_feet, vary: {density_kg_per_m3: {from: 1000, to: 1300}}}"),
             Contains("a plate in contact with other bodies does not scale with it"));
}

TEST_CASE("a body that is only touched by others need not have the height of what is tapped",
          "[protocols][contacts]") {
  CHECK(refusal("size_m: [0.02, 0.02, 0.01]", "size_m: [0.03, 0.03, 0.02]") == "accepted");
}

using namespace tapstudy::protocols;

namespace {
FormItem item(ItemKind kind) {
  FormItem one;
  one.kind = kind;
  one.steps = 5;
  one.min = 18;
  one.max = 99;
  one.options = {{"left", "links"}, {"right", "rechts"}};
  return one;
}
bool takes(const FormItem& one, const std::string& answer) {
  return wrong_with(one, answer).empty();
}
}  // namespace

TEST_CASE("an item of a form takes what its kind allows and nothing else", "[protocols][forms]") {
  const FormItem likert = item(ItemKind::likert);
  CHECK((takes(likert, "1") && takes(likert, "5")));
  CHECK_FALSE((takes(likert, "0") || takes(likert, "6") || takes(likert, "2.5") ||
               takes(likert, "nan") || takes(likert, "1 ") || takes(likert, "x")));
  const FormItem scale = item(ItemKind::scale);
  CHECK((takes(scale, "0") && takes(scale, "0.37") && takes(scale, "1")));
  CHECK_FALSE((takes(scale, "-0.01") || takes(scale, "1.01") || takes(scale, "inf")));
  const FormItem number = item(ItemKind::number);
  CHECK((takes(number, "18") && takes(number, "33.5")));
  CHECK_FALSE((takes(number, "17") || takes(number, "1e9") || takes(number, "0x20")));
  const FormItem choice = item(ItemKind::single_choice);
  CHECK(takes(choice, "left"));
  CHECK_FALSE((takes(choice, "Left") || takes(choice, "1")));
  const FormItem several = item(ItemKind::multiple_choice);
  CHECK((takes(several, "left") && takes(several, "right") && takes(several, "left;right")));
  CHECK_FALSE((takes(several, "right;left") || takes(several, "left;left") ||
               takes(several, "left;") || takes(several, ";left") || takes(several, "middle")));
  const FormItem text = item(ItemKind::text);
  CHECK(takes(text, "anything, \"quoted\""));
  CHECK_FALSE(takes(text, std::string(6000, 'x')));
}

TEST_CASE("only what is not required may be left out", "[protocols][forms]") {
  for (const ItemKind kind : {ItemKind::likert, ItemKind::scale, ItemKind::number,
                              ItemKind::single_choice, ItemKind::multiple_choice, ItemKind::text}) {
    FormItem one = item(kind);
    CHECK_FALSE(takes(one, ""));
    one.is_required = false;
    CHECK(takes(one, ""));
  }
}

namespace {
std::string names_of(const std::vector<FormItem>& items) {
  std::string names;
  for (const FormItem& one : items) {
    names += one.name + " ";
  }
  return names;
}

FormItem asked_if(const std::string& name, const AnswerCondition& condition) {
  FormItem made = item(ItemKind::single_choice);
  made.name = name;
  made.asked_if = condition;
  return made;
}
}  // namespace

TEST_CASE("an item is asked of whom gave such an answer to an item that was asked",
          "[protocols][forms]") {
  FormItem first = item(ItemKind::multiple_choice);
  first.name = "first";
  const Form form{"own",
                  "",
                  "",
                  {first, asked_if("second", {"own", "first", {"right"}}),
                   asked_if("third", {"own", "second", {"left", "right"}}),
                   asked_if("other", {"before", "hand", {"left"}})}};
  CHECK(names_of(asked_items(form_after(form, {{"before", {{"hand", "left"}}}}), {})) ==
        "first other ");
  const Form after = form_after(form, {{"before", {{"hand", "right"}}}});
  CHECK(names_of(after.items) == "first second third ");
  CHECK(names_of(form_after(form, {}).items) == "first second third ");
  CHECK(names_of(asked_items(after, {{"first", "left"}})) == "first ");
  CHECK(names_of(asked_items(after, {{"first", "left;right"}})) == "first second ");
  CHECK(names_of(asked_items(after, {{"first", "right"}, {"second", "left"}})) ==
        "first second third ");
  // an answer to what is not asked decides nothing
  CHECK(names_of(asked_items(after, {{"first", "left"}, {"second", "left"}})) == "first ");
}

TEST_CASE("the first answer of those that end a session is the one that does",
          "[protocols][forms]") {
  FormItem agree = item(ItemKind::single_choice);
  agree.name = "agree";
  agree.ends_session = {"right"};
  FormItem hidden = asked_if("hidden", {"own", "agree", {"right"}});
  hidden.ends_session = {"left"};
  FormItem last = item(ItemKind::likert);
  last.name = "last";
  last.ends_session = {"1", "2"};
  const Form form{"own", "", "", {agree, hidden, last}};
  CHECK_FALSE(item_that_ends(form, {}));
  CHECK_FALSE(item_that_ends(form, {{"agree", "left"}, {"last", "3"}}));
  CHECK(item_that_ends(form, {{"agree", "right"}, {"last", "1"}})->name == "agree");
  CHECK(item_that_ends(form, {{"agree", "left"}, {"hidden", "left"}, {"last", "2"}})->name ==
        "last");
}

TEST_CASE("a condition on an answer that nobody can have given is one error",
          "[protocols][forms]") {
  const auto [from, to, said] = GENERATE(table<std::string, std::string, std::string>({
      {"{item: held, is: [a glove]}", "{item: later, is: [a glove]}",
       "'later' is not a known item with such answers"},
      {"{item: held, is: [a glove]}", "{item: age, is: [20]}",
       "'age' is not a known item with such answers"},
      {"{item: held, is: [a glove]}", "{item: held, is: [a sock]}",
       "'a sock' is not a known answer"},
      {"{item: held, is: [a glove]}", "{form: rating, item: real, is: [1]}",
       "'rating' is not a known form that stands before"},
      {"{item: held, is: [a glove]}", "{item: held}", "missing"},
      {"required: false}\nforms_before: [about]",
       "asked_if: {form: about, item: hand, is: [left]}}\nforms_before: [rating]",
       "must have 'about' before 'rating'"},
      {"    instructions: Now",
       "    presented_if: {form: rating, item: real, is: [1]}\n    instructions: Now",
       "'rating' is not a known form of forms_before"},
      {"[a stylus, a glove", "[a stylus; a pen, a glove", "stands between the choices"},
      {"[left, right]", "[left, none]", "are not all among left, right, ambidextrous"},
      {"required: false, bids: age", "required: false, bids: sex", "of kind single_choice"},
      {"kind: text, question: \"What else?\"",
       "bids: age, kind: number, min: 0, max: 1, question: \"What else?\"", "for two items"},
  }));
  INFO(from << " → " << to);
  const std::string error = refusal(testing::replaced(
      testing::contents(testing::source("tests/data/every_screen.yaml")), from, to));
  CHECK_THAT(error, Contains(said));
  CHECK(std::count(error.begin(), error.end(), '\n') == 0);
}

TEST_CASE("NASA's task load index has its six scales", "[protocols][forms]") {
  for (const std::string& language : nasa_tlx_languages()) {
    const Form form = nasa_tlx(language);
    REQUIRE(form.items.size() == 6);
    for (std::size_t i = 0; i < 6; ++i) {
      CHECK(form.items[i].name == nasa_tlx("en").items[i].name);
      CHECK(form.items[i].kind == ItemKind::scale);
      CHECK(form.items[i].is_required);
      CHECK_FALSE(form.items[i].question.empty());
    }
  }
}

TEST_CASE("NASA's task load index is asked in the language of the session, else in English",
          "[protocols][forms]") {
  CHECK(nasa_tlx("de").title != nasa_tlx("en").title);
  CHECK(nasa_tlx("fr").title == nasa_tlx("en").title);
  const auto study = tapstudy::testing::shipped("recommended/discrimination.yaml").string();
  CHECK(read_protocol(study, "ja").forms.at("load").title == nasa_tlx("ja").title);
  CHECK(read_protocol(study).forms.at("load").title == nasa_tlx("en").title);
}

TEST_CASE("the ends of a confidence scale without words of its own are in the session's language",
          "[protocols]") {
  const tapstudy::testing::TempDirectory directory;
  const std::string study = directory / "study.yaml";
  tapstudy::testing::write(
      study,
      tapstudy::testing::replaced(
          tapstudy::testing::contents(tapstudy::testing::shipped("paper/discrimination.yaml")),
          "    task: identification", "    task: identification\n    confidence: {steps: 5}"));
  CHECK(read_protocol(study).blocks.front().confidence->low == "guessed");
  CHECK(read_protocol(study, "de").blocks.front().confidence->high == "sicher");
  CHECK(read_protocol(study, "fr").blocks.front().confidence->high == "certain");
}
