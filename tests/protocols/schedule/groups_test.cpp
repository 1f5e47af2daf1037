#include "protocols/schedule/groups.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <set>

#include "core/error.hpp"
#include "protocols/schedule/ordering.hpp"
#include "protocols/schedule/schedule.hpp"
#include "support/blocks.hpp"
#include "support/catch.hpp"
using namespace tapstudy;

namespace {
using testing::Names;
using testing::stimuli_of;

Names blocks_in(const protocols::Schedule& schedule) {
  Names names;
  for (const protocols::PlannedTrial& trial : schedule) {
    if (names.empty() || names.back() != trial.block) {
      names.push_back(trial.block);
    }
  }
  return names;
}

// What refuses it, or that nothing does.
std::string outcome_of(const std::function<void()>& read) {
  try {
    read();
  } catch (const core::InvalidInput& error) {
    return error.what();
  }
  return "was read";
}

const Names blocks{"practice", "a", "b", "c", "test"};
const std::string three_groups =
    "groups:\n"
    "  - {name: short, blocks: [practice, test]}\n"
    "  - {name: long, label: long training}\n"
    "  - {name: middle, blocks: [a, b, practice, test]}\n";
}  // namespace

TEST_CASE(
    "of each run of as many participants as there are groups one is in each, whatever the seed",
    "[protocols][groups]") {
  const std::string seed = "counterbalancing_seed: " + std::to_string(GENERATE(0, 1, 2, 77)) + "\n";
  const protocols::Protocol protocol = testing::with_blocks(blocks, three_groups + seed);
  std::set<Names> orders;  // of the groups in a run
  for (int participants = 0; participants <= 120; ++participants) {
    const int each = participants / 3;
    Names run;
    for (const protocols::Group& group : protocol.groups) {
      const int members = protocols::members(protocol, &group, participants);
      CHECK((members == each || members == each + 1));
    }
    for (int i = participants; participants % 3 == 0 && i < participants + 3; ++i) {
      run.push_back(protocols::group_of(protocol, i)->name);
    }
    if (!run.empty()) {
      CHECK(std::set<std::string>(run.begin(), run.end()).size() == 3);
      orders.insert(run);
    }
  }
  CHECK(orders.size() == 6);  // nobody can tell who is next in which group
}

TEST_CASE("another counterbalancing seed assigns otherwise, a participant's own seed does not",
          "[protocols][groups]") {
  const auto assigned = [](const protocols::Protocol& protocol) {
    Names names;
    for (int i = 0; i < 30; ++i) {
      names.push_back(protocols::group_of(protocol, i)->name);
    }
    return names;
  };
  CHECK(assigned(testing::with_blocks(blocks, three_groups)) !=
        assigned(testing::with_blocks(blocks, three_groups + "counterbalancing_seed: 2\n")));
  const protocols::Protocol protocol = testing::with_blocks(blocks, three_groups);
  for (int i = 0; i < 6; ++i) {
    CHECK(blocks_in(make_schedule(protocol, 1, i)) == blocks_in(make_schedule(protocol, 2, i)));
  }
}

TEST_CASE("a participant does the blocks of the group, in the file's order, and no others",
          "[protocols][groups]") {
  const protocols::Protocol protocol = testing::with_blocks(blocks, three_groups);
  const std::map<std::string, Names> expected{{"short", {"practice", "test"}},
                                              {"long", blocks},
                                              {"middle", {"practice", "a", "b", "test"}}};
  for (int i = 0; i < 12; ++i) {
    CHECK(blocks_in(make_schedule(protocol, 5, i)) ==
          expected.at(protocols::group_of(protocol, i)->name));
  }
  CHECK(protocol.group("long").label == "long training");
  CHECK(protocol.group("short").label == "short");
}

TEST_CASE("orders of blocks and of stimuli are balanced within each group", "[protocols][groups]") {
  const protocols::Protocol protocol = testing::with_blocks(
      blocks, three_groups + "block_order: {order: williams, blocks: [a, b, c]}\n");
  CHECK(protocols::balanced_block_orders(protocol, &protocol.group("short")) == 1);
  CHECK(protocols::balanced_block_orders(protocol, &protocol.group("middle")) == 2);
  CHECK(protocols::balanced_block_orders(protocol, &protocol.group("long")) == 6);
  constexpr int each = 12;  // a multiple of all these, and of the six orders of three stimuli
  std::map<std::string, std::map<Names, int>> orders;
  std::map<std::string, std::map<Names, int>> stimuli;
  for (int i = 0; i < 3 * each; ++i) {
    const auto schedule = make_schedule(protocol, 1, i);
    const std::string group = protocols::group_of(protocol, i)->name;
    ++orders[group][blocks_in(schedule)];
    ++stimuli[group][stimuli_of("test", schedule)];
  }
  CHECK(orders["short"].size() == 1);
  CHECK(orders["middle"].size() == 2);
  CHECK(orders["long"].size() == 6);
  for (const auto& [group, counts] : stimuli) {
    CHECK(counts.size() == 6);
  }
  for (const auto* const all : {&orders, &stimuli}) {
    for (const auto& [group, counts] : *all) {
      for (const auto& [order, count] : counts) {
        CHECK(count * std::ssize(counts) == each);
      }
    }
  }
}

TEST_CASE("a group with an order of its own does its blocks in it, the others as they are dealt",
          "[protocols][groups]") {
  const Names own_practice{"practice_a", "a", "practice_b", "b", "practice_c", "c"};
  const protocols::Protocol protocol = testing::with_blocks(
      own_practice,
      "block_order: {order: williams}\n"
      "groups:\n  - {name: fixed, block_order: [c, a, b]}\n  - {name: dealt}\n");
  CHECK(protocols::balanced_block_orders(protocol, &protocol.group("fixed")) == 1);
  CHECK(protocols::balanced_block_orders(protocol, &protocol.group("dealt")) == 6);
  std::map<std::string, std::set<Names>> orders;
  for (int i = 0; i < 24; ++i) {
    orders[protocols::group_of(protocol, i)->name].insert(blocks_in(make_schedule(protocol, 1, i)));
  }
  CHECK(orders["fixed"] ==
        std::set<Names>{{"practice_c", "c", "practice_a", "a", "practice_b", "b"}});
  CHECK(orders["dealt"].size() == 6);
}

TEST_CASE("blocks that a group's own order does not name stay where they are",
          "[protocols][groups]") {
  const protocols::Protocol protocol = testing::with_blocks(
      blocks, "groups:\n  - {name: own, block_order: [test, a]}\n  - {name: other}\n");
  for (int i = 0; i < 4; ++i) {
    const Names expected = protocols::group_of(protocol, i)->name == "own"
                               ? Names{"practice", "test", "b", "c", "a"}
                               : blocks;
    CHECK(blocks_in(make_schedule(protocol, 3, i)) == expected);
  }
}

TEST_CASE("a group is presented its own stimuli of a block, equally often, and no others",
          "[protocols][groups]") {
  const protocols::Protocol protocol = testing::with_blocks(
      {"a", "test"},
      "groups:\n  - {name: two, stimuli: {test: [acrylic_two, mdf_two]}}\n  - {name: all}\n");
  for (int i = 0; i < 12; ++i) {
    const auto schedule = make_schedule(protocol, 5, i);
    const bool is_two = protocols::group_of(protocol, i)->name == "two";
    std::map<std::string, int> counts;
    for (const std::string& stimulus : stimuli_of("test", schedule)) {
      ++counts[stimulus];
    }
    CHECK(counts == (is_two ? std::map<std::string, int>{{"acrylic_two", 1}, {"mdf_two", 1}}
                            : std::map<std::string, int>{
                                  {"acrylic_two", 1}, {"mdf_two", 1}, {"mdf_three", 1}}));
    CHECK(stimuli_of("a", schedule).size() == 3);
  }
  const protocols::Block& test = protocol.block("test");
  CHECK(protocols::answers_of(test, protocol).options.size() == 3);
}

TEST_CASE("without groups every participant does every block, in orders by the order index",
          "[protocols][groups]") {
  const protocols::Protocol protocol = testing::with_blocks(blocks, "");
  for (int i = 0; i < 6; ++i) {
    CHECK(protocols::group_of(protocol, i) == nullptr);
    CHECK(protocols::index_in_group(protocol, i) == i);
    CHECK(blocks_in(make_schedule(protocol, 5, i)) == blocks);
  }
}

TEST_CASE("groups that cannot be are refused at their place, with what is allowed",
          "[protocols][groups]") {
  const auto refused = [](const std::string& groups, const std::string& where,
                          const std::string& why) {
    INFO(groups);
    const std::string text =
        testing::text_with_blocks({"practice", "a", "b"}, "groups:\n" + groups);
    const auto line = std::count(
        text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find("groups:\n")), '\n');
    try {
      protocols::parse_protocol(text, "study.yaml");
      FAIL("was read");
    } catch (const core::InvalidInput& error) {
      const std::string said = error.what();
      INFO(said);
      CHECK(said.find("study.yaml:" + std::to_string(line + 1 + std::stoi(where)) + ":") !=
            std::string::npos);
      CHECK(said.find(why) != std::string::npos);
      CHECK(std::count(said.begin(), said.end(), '\n') == 0);  // one error, no follow-on ones
    }
  };
  const std::string other = "  - {name: y}\n";
  refused("  - {name: x, blocks: [a, c]}\n" + other, "1", "'c' is not a known block");
  refused("  - {name: x, blocks: [practice, c]}\n" + other, "1", "'c' is not a known block");
  refused("  - {name: x, blocks: [a, a]}\n" + other, "1", "'a' is listed twice");
  refused("  - {name: x, blocks: []}\n" + other, "1", "at least one block");
  refused("  - {name: x, blocks: [practice]}\n" + other, "1", "practice alone");
  refused("  - {name: x, blocks: [a]}\n  - {name: y, blocks: [a, practice]}\n", "1",
          "block 'b' is in none of them");
  refused(other + "  - {name: y, blocks: [a]}\n", "2", "'y' is the name of an earlier group");
  refused("  - {name: x}\n", "1", "must be two or more");
  refused("  []\n", "1", "must be two or more");
  refused("  - {name: x y}\n" + other, "1", "name");
  refused("  - {blocks: [a]}\n" + other, "1", "name");
  refused("  - {name: x, block_order: [b, practice]}\n" + other, "1", "may move");
  refused("  - {name: x, blocks: [a], block_order: [a, b]}\n" + other, "1",
          "'b' is not a known block of the group");
  refused("  - {name: x, block_order: [b]}\n" + other, "1", "names no two blocks");
  refused("  - {name: x, stimuli: {c: [mdf_two]}}\n" + other, "1", "is no block that the group");
  refused("  - {name: x, blocks: [a], stimuli: {b: [mdf_two, mdf_three]}}\n" + other, "1",
          "(one of: a)");
  refused("  - {name: x, stimuli: {b: [mdf_two, wood]}}\n" + other, "1",
          "'wood' is not a known stimulus of the block");
  refused("  - {name: x, stimuli: {b: [mdf_two]}}\n" + other, "1", "at least two stimuli");
}

TEST_CASE("what is stated for all groups and concerns none is refused", "[protocols][groups]") {
  const auto refusal = [](const std::string& keys) {
    return outcome_of([&] { testing::with_blocks({"a", "b"}, keys); });
  };
  const std::string fixed = "  - {name: x, block_order: [b, a]}\n";
  CHECK_THAT(refusal("block_order: {order: williams}\ngroups:\n" + fixed +
                     "  - {name: y, block_order: [a, b]}\n"),
             Contains("block_order: is of no group"));
  CHECK_THAT(refusal("block_order: {order: williams}\ngroups:\n" + fixed + "  - {name: y}\n"),
             Contains("was read"));
  CHECK_THAT(refusal("groups:\n  - {name: x, stimuli: {a: [mdf_two, mdf_three]}}\n"
                     "  - {name: y, blocks: [b]}\n"),
             Contains("'acrylic_two' of block 'a' is presented to none"));
}

TEST_CASE("shares of right answers of groups are compared where the same answers are right",
          "[protocols][groups]") {
  const std::string whole = testing::contents(testing::shipped("paper/discrimination.yaml"));
  const auto read = [&](const std::string& own, const std::string& claim) {
    const std::string text =
        whole.substr(0, whole.find("\nblocks:")) +
        "\nblocks:\n  - {name: test, task: identification, question: \"Which?\", response_factor: "
        "material, stimuli: [mdf_two, mdf_three, acrylic_two, acrylic_three]}\n"
        "groups:\n  - {name: x, stimuli: {test: [mdf_two, acrylic_two]}}\n"
        "  - {name: y, stimuli: {test: " +
        own + "}}\nhypotheses:\n  - {name: h, statement: S., block: test, claim: " + claim + "}\n";
    protocols::parse_protocol(text, "study.yaml");
  };
  const std::string differ = "groups_differ, groups: [x, y]";
  CHECK_NOTHROW(read("[mdf_three, acrylic_three]", differ));
  CHECK_THROWS_WITH(read("[mdf_three, acrylic_two, acrylic_three]", differ),
                    Contains("hypotheses[0].groups") && Contains("other right answers"));
  CHECK_NOTHROW(read("[mdf_three, acrylic_two, acrylic_three]", "accuracy_above_chance"));
  CHECK_THROWS_WITH(
      read("[mdf_three, acrylic_three]", "interaction, factors: [material, structure]"),
      Contains("is not presented all of its stimuli"));
}

TEST_CASE("a group has stimuli of its own only of a block where others need not be compared",
          "[protocols][groups]") {
  const auto refusal = [](const std::string& keys) {
    const std::string whole = testing::contents(testing::shipped("paper/discrimination.yaml"));
    const std::string text = whole.substr(0, whole.find("\nblocks:")) +
                             "\nblocks:\n  - {name: how, task: rating, question: \"How?\", low: a, "
                             "high: b, stimuli: [mdf_two, acrylic_two]}\n"
                             "  - {name: which, task: identification, question: \"Which?\", "
                             "stimuli: [mdf_two, acrylic_two]}\n"
                             "simulation: {observer: {reference: mdf_two}}\n" +
                             keys;
    return outcome_of([&] { protocols::parse_protocol(text, "study.yaml"); });
  };
  CHECK_THAT(refusal("groups: [{name: x, stimuli: {how: [mdf_two]}}, {name: y}]\n"),
             Contains("groups[0].stimuli.how: its stimuli are compared"));
  CHECK(refusal("groups: [{name: x, stimuli: {which: [mdf_two]}}, {name: y}]\n") == "was read");
  CHECK_THAT(refusal("sessions: [{name: d1, blocks: [how, which]}, {name: d2, blocks: [which]}]\n"
                     "groups: [{name: x, stimuli: {which: [mdf_two], which.d2: [acrylic_two]}}, "
                     "{name: y}]\n"),
             Contains("is block 'which.d2', whose stimuli are given already"));
}
