// Hypotheses that nothing could contradict.
#include "core/error.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
std::string answer_to_equivalence(const std::string& keys) {
  const std::string file = testing::source("tests/data/every_key.yaml");
  const std::string usual =
      "block: rated.day_1, claim: equivalent, stimulus: a, to: b, within: 0.5";
  try {
    protocols::parse_protocol(
        testing::replaced(testing::contents(file), usual, "claim: equivalent, " + keys), file);
  } catch (const core::InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}

std::string answer_to_groups(const std::string& keys) {
  const std::string file = testing::source("tests/data/every_key.yaml");
  const std::string usual = "block: material, claim: groups_differ, groups: [trained, all_blocks]";
  try {
    protocols::parse_protocol(testing::replaced(testing::contents(file), usual, keys), file);
  } catch (const core::InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}
}  // namespace

TEST_CASE("two groups are compared in a block that both do and that has values of participants",
          "[protocols][hypotheses]") {
  const auto [keys, said] = GENERATE(table<std::string, std::string>(
      {{"block: material, claim: groups_differ, groups: [all_blocks, trained]", "accepted"},
       {"block: stiffness, claim: groups_differ, groups: [all_blocks, trained]", "accepted"},
       {"block: abx, claim: groups_differ, groups: [all_blocks, trained]",
        "'trained' is not a known group that does the block (one of: all_blocks"},
       {"block: material, claim: groups_differ, groups: [trained]", "two groups are compared"},
       {"block: material, claim: groups_differ", "groups: is missing"},
       {"block: material, claim: groups_differ, groups: [trained, all_blocks], stimulus: a",
        "stimulus"},
       {"block: practice, claim: groups_differ, groups: [trained, all_blocks]", "is practice"}}));
  CHECK_THAT(answer_to_groups(keys), Contains(said));
}

TEST_CASE("blocks that measure different things are not compared", "[protocols][hypotheses]") {
  const std::string blocks =
      GENERATE(as<std::string>{}, "block: abx, to_block: pairs", "block: abx, to_block: marked",
               "block: abx, to_block: stiffness", "block: adjusted, to_block: cut_and_try");
  CHECK_THAT(answer_to_equivalence(blocks + ", within: 0.1"),
             Contains("hypotheses[2].to_block: measures ") && Contains("not one measure"));
}

TEST_CASE("an equivalence within a bound that no difference can exceed is refused",
          "[protocols][hypotheses]") {
  struct Case {
    const char* compared;
    const char* allowed;  // just
    const char* refused;
    const char* said;
  };
  const auto [compared, allowed, refused, said] = GENERATE(values<Case>({
      {"block: abx, stimulus: a, to: b", "0.99", "1",
       "1 is not allowed: it is the largest difference of shares of right answers that is none "
       "(greater than 0 and less than 1: no difference exceeds 1)"},
      {"block: rated.day_1, stimulus: a, to: b", "3.9", "4",
       "of ratings in 5 steps that is none (greater than 0 and less than 4"},
      {"block: marked, stimulus: a, to: b", "0.99", "1", "of marks on a line"},
      {"block: stiffness, to_block: stiffness_by_density", "1.1", "1",
       "the largest ratio of thresholds that is none (greater than 1)"},
  }));
  CAPTURE(compared);
  const auto within = [&, of = std::string{compared}](const std::string& bound) {
    return answer_to_equivalence(of + ", within: " + bound);
  };
  CHECK(within(allowed) == "accepted");
  CHECK_THAT(within(refused), Contains("hypotheses[2].within: ") && Contains(said));
}
