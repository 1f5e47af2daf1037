// Which plate a participant's page draws: never one that tells the answer, or that is not felt.
#include "runner/console/scenes.hpp"

#include "support/catch.hpp"
#include "support/varied_study.hpp"
using namespace tapstudy;

TEST_CASE("a plate is drawn unless its size varies, for the picture would be of another one",
          "[runner][console]") {
  const auto is_drawn = [](const std::string& axis) {
    const protocols::Protocol protocol = testing::varied_study({axis});
    protocols::Block block;
    block.stimuli = {"a"};
    return runner::Scenes{protocol, protocol.placement}.number_of("a", block).has_value();
  };
  CHECK(is_drawn("youngs_modulus_pa: {from: 1e9, to: 5e9}"));
  CHECK(is_drawn("poissons_ratio: {values: [0.2, 0.3]}"));
  CHECK_FALSE(is_drawn("thickness_m: {values: [0.02, 0.03]}"));
  CHECK_FALSE(is_drawn("lateral_size_m: {values: [0.6, 0.7]}"));
}
