// What `check` says of a study's design.
#include "support/blocks.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
std::string checked(const std::string& protocol) {
  const testing::TempDirectory directory;
  const std::string file = directory / "study.yaml";
  testing::write(file, protocol);
  const auto result = testing::tapstudy({"check", file});
  CHECK(result.exit_code == 0);
  return result.standard_output;
}
}  // namespace

TEST_CASE("an order of blocks is advised exactly where some could exchange their places",
          "[end_to_end][check]") {
  const auto [keys, is_advised] = GENERATE(table<std::string, bool>(
      {{"", true},
       {"groups: [{name: a}, {name: b}]\n", true},
       {"groups: [{name: g1, blocks: [one, three]}, {name: g2, blocks: [two, four]}]\n", true},
       {"groups: [{name: g1, blocks: [one]}, {name: g2, blocks: [two, three]}, "
        "{name: g3, blocks: [four]}]\n",
        true},
       {"groups: [{name: g1, blocks: [one]}, {name: g2, blocks: [two]}, {name: g3, blocks: "
        "[three]},"
        " {name: g4, blocks: [four]}]\n",
        false},
       {"sessions: [{name: d1, blocks: [one, two]}, {name: d2, blocks: [three, four]}]\n", true},
       {"sessions: [{name: d1, blocks: [one]}, {name: d2, blocks: [two]}, "
        "{name: d3, blocks: [three]}, {name: d4, blocks: [four]}]\n",
        false}}));
  CAPTURE(keys);
  const std::string said =
      checked(testing::text_with_blocks({"one", "two", "three", "four"}, keys));
  CHECK((said.find("block_order: {order: williams}") != std::string::npos) == is_advised);
}

TEST_CASE("a language is complete only where no text is given once for all",
          "[end_to_end][check]") {
  const std::string text =
      testing::text_with_blocks({"one"}, "instructions: {en: Tap, de: Klopf}\n");
  // title, question and four labels
  CHECK_THAT(checked(text), Contains("  de: all but 6 texts given once for all languages"));
}

TEST_CASE("check says which order and stimuli a group has of its own, and counts its trials",
          "[end_to_end][check]") {
  const std::string said = checked(testing::text_with_blocks(
      {"practice", "a", "b"},
      "groups:\n  - {name: own, block_order: [b, a], stimuli: {b: [mdf_two, mdf_three]}}\n"
      "  - {name: other}\n"));
  INFO(said);
  CHECK_THAT(said, Contains("order of blocks: practice (practice), b, a\n") &&
                       Contains("order of blocks: practice (practice), a, b\n"));
  CHECK_THAT(said,
             Contains("group own: practice, a, b; in the order b, a; of b: mdf_two, mdf_three; "
                      "8 trials; ") &&
                 Contains("group other: practice, a, b; 9 trials; "));
  CHECK_THAT(said, Contains("2  b: 2 trials\n") && Contains("3  b: 3 trials\n"));
}
