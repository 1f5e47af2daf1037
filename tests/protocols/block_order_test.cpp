#include "protocols/block_order.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "core/error.hpp"
#include "protocols/read_protocol.hpp"
#include "protocols/schedule.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
using Names = std::vector<std::string>;

// Blocks whose names begin with "practice" are practice.
protocols::Protocol study(const Names& blocks, const std::string& order) {
  const std::string whole = testing::contents(testing::shipped("paper/discrimination.yaml"));
  std::string text = whole.substr(0, whole.find("\nblocks:")) + "\nblocks:\n";
  for (const std::string& name : blocks) {
    text += "  - {name: " + name + ", task: identification, question: \"Which?\", " +
            "stimuli: [mdf_two, mdf_three], repetitions: 2" +
            (name.starts_with("practice") ? ", practice: true}\n" : "}\n");
  }
  text += order.empty() ? "" : "block_order: " + order + "\n";
  return protocols::parse_protocol(text, "study.yaml");
}

Names names_of(const protocols::Protocol& protocol, std::uint64_t seed, int order_index) {
  Names names;
  for (const std::size_t i : protocols::block_sequence(protocol, seed, order_index)) {
    names.push_back(protocol.blocks[i].name);
  }
  return names;
}
}  // namespace

TEST_CASE(
    "over as many participants as there are balanced orders, every block follows every other "
    "equally often",
    "[protocols][schedule]") {
  const Names blocks = GENERATE(Names{"a", "b"}, Names{"a", "b", "c"}, Names{"a", "b", "c", "d"});
  const protocols::Protocol protocol = study(blocks, "{order: williams}");
  const int orders = protocols::balanced_block_orders(protocol);
  CHECK(orders == (blocks.size() % 2 == 0 ? 1 : 2) * std::ssize(blocks));
  for (const int first : {0, 5 * orders}) {
    std::map<std::pair<std::string, std::string>, int> followed;
    for (int i = first; i < first + orders; ++i) {
      const Names names = names_of(protocol, 1, i);
      for (std::size_t k = 1; k < names.size(); ++k) {
        ++followed[{names[k - 1], names[k]}];
      }
    }
    CHECK(followed.size() == blocks.size() * (blocks.size() - 1));
    CHECK(std::ranges::all_of(
        followed, [&](const auto& pair) { return pair.second == followed.begin()->second; }));
  }
}

TEST_CASE("random orders of blocks follow from the participant's seed, and all occur",
          "[protocols][schedule]") {
  const protocols::Protocol protocol = study({"a", "b", "c"}, "{order: shuffle}");
  std::set<Names> seen;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    CHECK(names_of(protocol, seed, 0) == names_of(protocol, seed, 1));
    seen.insert(names_of(protocol, seed, 0));
  }
  CHECK(seen.size() == 6);
  CHECK(names_of(study({"a", "b", "c"}, ""), 7, 3) == Names{"a", "b", "c"});
}

TEST_CASE("practice moves with the block after it, and blocks that are not named stay",
          "[protocols][schedule]") {
  const protocols::Protocol protocol =
      study({"control", "practice_a", "a", "between", "practice_b", "practice_b2", "b", "practice"},
            "{order: williams, blocks: [a, b]}");
  std::set<Names> seen;
  for (int i = 0; i < 2; ++i) {
    seen.insert(names_of(protocol, 1, i));
  }
  CHECK(seen == std::set<Names>{{"control", "practice_a", "a", "between", "practice_b",
                                 "practice_b2", "b", "practice"},
                                {"control", "practice_b", "practice_b2", "b", "between",
                                 "practice_a", "a", "practice"}});
}

TEST_CASE("trials are numbered in the order of the blocks, and each block keeps its own order",
          "[protocols][schedule]") {
  const protocols::Protocol protocol = study({"a", "b"}, "{order: williams}");
  std::map<std::string, std::set<Names>> stimuli;
  for (int i = 0; i < 2; ++i) {
    const auto first = protocols::first_trials(protocol, 9, i);
    int number = 0;
    std::map<std::string, Names> order;
    for (const protocols::PlannedTrial& trial : protocols::make_schedule(protocol, 9, i)) {
      CHECK(trial.number == ++number);
      order[trial.block].push_back(trial.alternatives.front().stimulus);
      CHECK(trial.number == first.at(trial.block) + std::ssize(order[trial.block]) - 1);
    }
    for (const auto& [block, names] : order) {
      stimuli[block].insert(names);
    }
  }
  CHECK(stimuli.at("a").size() == 1);  // one seed, whatever place the block has
  CHECK(stimuli.at("b").size() == 1);
}

TEST_CASE("an order of blocks that is none is refused", "[protocols]") {
  const auto refused = [](const std::string& order, const std::string& why) {
    CHECK_THROWS_WITH(study({"practice", "a", "b"}, order),
                      Contains("block_order") && Contains(why));
  };
  refused("{order: williams, blocks: [a]}", "two blocks or more");
  refused("{order: williams, blocks: [a, c]}", "'c' is not");
  refused("{order: williams, blocks: [practice, a]}", "'practice' is not");
  refused("{order: williams, blocks: [a, a]}", "twice");
  refused("{order: listed}", "'listed' is not");
  refused("{}", "order");
  CHECK_THROWS_WITH(study({"a"}, "{order: shuffle}"), Contains("two blocks or more"));
}
