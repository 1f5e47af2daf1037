#include "core/error.hpp"
#include "protocols/protocol.hpp"
#include "protocols/read_protocol.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
std::string example() {
  return testing::contents(testing::shipped("examples/stiffness_jnd_by_damping.yaml"));
}

std::string refusal_of(const std::string& from, const std::string& to) {
  try {
    protocols::parse_protocol(testing::replaced(example(), from, to), "study.yaml");
  } catch (const core::InvalidInput& error) {
    return error.what();
  }
  return "";
}
}  // namespace

TEST_CASE("a procedure varies as many axes as its block names, which its stimulus must have",
          "[protocols][tasks]") {
  const protocols::Protocol protocol = protocols::parse_protocol(example(), "study.yaml");
  const protocols::Comparison& comparison = *protocol.blocks.front().comparison;
  CHECK(comparison.axis == "youngs_modulus_pa");
  CHECK(comparison.further_axes == std::vector<std::string>{"damping_scale"});
  CHECK(comparison.tracks.front()->axes() == 2);

  CHECK_THAT(refusal_of("    further_axes: [damping_scale]\n", ""),
             Contains("procedures[0]: varies 2 axes") && Contains("the block has 1"));
  CHECK_THAT(refusal_of("[damping_scale]", "[youngs_modulus_pa]"),
             Contains("blocks[0].further_axes") && Contains("youngs_modulus_pa"));
  CHECK_THAT(refusal_of("[damping_scale]", "[thickness_m]"), Contains("blocks[0].further_axes"));
  CHECK_THAT(refusal_of("[damping_scale]", "[damping_scale, damping_scale]"),
             Contains("is listed twice"));
  CHECK_THAT(refusal_of("[damping_scale]", "[]"), Contains("blocks[0].further_axes"));
  CHECK_THAT(refusal_of("values: [0.5, 1, 2, 4]", "values: [0.5, 1, 2, 5]"),
             Contains("further_axes[0]") && Contains("damping_scale"));
  CHECK_THAT(refusal_of("- quest_plus:",
                        "- constant: {values: [0.1], repetitions: 2}\n"
                        "      - quest_plus:"),
             Contains("procedures[0]: varies 1 axes") && Contains("the block has 2"));
}
