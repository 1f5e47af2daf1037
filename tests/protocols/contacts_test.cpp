// What plates touch, as it is read.
#include "core/error.hpp"
#include "protocols/read_protocol.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

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
