// The standard of a comparison.
#include "core/error.hpp"
#include "protocols/protocol.hpp"
#include "protocols/read_protocol.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
// The example, with a table of thicknesses instead of Young's modulus.
protocols::Protocol tabled(const std::string& thicknesses, const std::string& standard) {
  std::string text = testing::contents(testing::shipped("examples/stiffness_jnd.yaml"));
  text = testing::replaced(text, "youngs_modulus_pa: {from: 3.2e9, to: 12.8e9, spacing: log}",
                           "thickness_m: " + thicknesses);
  text = testing::replaced(text, "    standard: 3.2e9\n", standard);
  return protocols::parse_protocol(text, "study.yaml");
}
std::string refusal_of_standard(const std::string& thicknesses, const std::string& standard) {
  try {
    tabled(thicknesses, standard);
  } catch (const core::InvalidInput& error) {
    return error.what();
  }
  return "";
}
}  // namespace

TEST_CASE("a standard that is not built is refused, for another plate would be presented",
          "[protocols][tasks]") {
  const std::string table = "{from: 0.05, to: 0.3, count: 51, spacing: linear}";
  CHECK(refusal_of_standard(table, "").empty());  // the plate's own 0.05 m
  CHECK(tabled(table, "    standard: 0.06\n").blocks.front().comparison->standard == 0.06);
  CHECK_THAT(refusal_of_standard(table, "    standard: 0.0624\n"),
             Contains("standard: 0.0624 is not among the values of thickness_m that are built "
                      "(the nearest is 0.06)"));
  CHECK_THAT(refusal_of_standard("{from: 0.04, to: 0.3, count: 11, spacing: linear}", ""),
             Contains("blocks[0].standard: 0.05 is not among"));
}

TEST_CASE("a block without procedures, where they are named, is refused", "[protocols][tasks]") {
  std::string text = testing::contents(testing::shipped("examples/stiffness_jnd.yaml"));
  text = testing::replaced(text.substr(0, text.find("    procedures:")), "    task: comparison\n",
                           "    task: comparison\n    procedures: []\n");
  CHECK_THROWS_WITH(protocols::parse_protocol(text, "study.yaml"),
                    Contains("procedures: is empty (at least one)"));
}
