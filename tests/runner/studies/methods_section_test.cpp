#include "runner/studies/methods_section.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "protocols/schedule/groups.hpp"
#include "protocols/schedule/schedule.hpp"
#include "runner/studies/study_summary.hpp"
#include "support/blocks.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
using testing::Names;

namespace {
// The oracle: each stimulus follows each other equally often.
bool are_sequences_balanced(const protocols::Protocol& protocol, const std::vector<int>& indices) {
  std::map<std::pair<std::string, std::string>, int> followed;
  for (const int order_index : indices) {
    const Names order =
        testing::stimuli_of("test", protocols::make_schedule(protocol, 1, order_index));
    for (std::size_t i = 1; i < order.size(); ++i) {
      ++followed[{order[i - 1], order[i]}];
    }
  }
  const std::size_t n = protocol.blocks.front().stimuli.size();
  return followed.size() == n * (n - 1) && std::ranges::all_of(followed, [&](const auto& pair) {
           return pair.second == followed.begin()->second;
         });
}
}  // namespace

TEST_CASE("methods call an order balanced exactly if it was over those who are reported",
          "[runner][report]") {
  const protocols::Protocol protocol = testing::with_blocks({"test"}, "");
  int balanced = 0;
  for (const std::vector<int>& indices :
       std::vector<std::vector<int>>{{0, 1, 2, 3, 4, 5},
                                     {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11},
                                     {6, 7, 8, 9, 10, 11},
                                     {0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5},
                                     {0, 0, 2, 3, 4, 5},  // a row that was given twice
                                     {0, 1, 2, 3, 4},
                                     {0, 1, 2, 3, 4, 5, 6}}) {
    CAPTURE(indices);
    std::vector<results::SessionRow> sessions;
    std::set<std::string> participants;
    for (const int order_index : indices) {
      results::SessionRow& session = sessions.emplace_back();
      session.participant_id = "P" + std::to_string(sessions.size());
      session.order_index = order_index;
      participants.insert(session.participant_id);
    }
    const std::string text = runner::describe_procedure(protocol, sessions, participants,
                                                        {{"test", {.participants = participants}}})
                                 .words;
    INFO(text);
    const auto says = [&](const char* words) { return text.find(words) != std::string::npos; };
    const bool is_balanced = are_sequences_balanced(protocol, indices);
    CHECK(says("balanced for immediate sequence") == is_balanced);
    CHECK(says("do not complete, of 6 orders") == !is_balanced);
    balanced += is_balanced ? 1 : 0;
  }
  CHECK(balanced == 4);
}

TEST_CASE("methods say of no participant that they did the blocks of another group",
          "[runner][report][groups]") {
  const bool are_own = GENERATE(true, false);
  const std::string groups = are_own ? "groups: [{name: g1, blocks: [one, test]}, "
                                       "{name: g2, blocks: [two, test]}]\n"
                                     : "groups: [{name: g1}, {name: g2}]\n";
  const protocols::Protocol protocol = testing::with_blocks({"one", "two", "test"}, groups);
  std::vector<results::SessionRow> sessions(2);
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    sessions.at(i).participant_id = i == 0 ? "P1" : "P2";
    sessions.at(i).group = {.name = i == 0 ? "g1" : "g2"};
  }
  const std::set<std::string> both{"P1", "P2"};
  const std::set<std::string> first = are_own ? std::set<std::string>{"P1"} : both;
  const std::set<std::string> second = are_own ? std::set<std::string>{"P2"} : both;
  const std::string text = runner::describe_procedure(protocol, sessions, both,
                                                      {{"one", {.participants = first}},
                                                       {"two", {.participants = second}},
                                                       {"test", {.participants = both}}})
                               .words;
  INFO(text);
  CHECK((text.find(", then 'two'") != std::string::npos) == !are_own);
  CHECK((text.find("Each group did its own of these blocks") != std::string::npos) == are_own);
}

namespace {
const std::string own_orders =
    "block_order: {order: williams}\n"
    "groups:\n"
    "  - {name: own, block_order: [b, test], stimuli: {test: [acrylic_two, mdf_two]}}\n"
    "  - {name: other}\n";
}  // namespace

TEST_CASE("methods say which order and which stimuli a group had of its own", "[runner][report]") {
  const protocols::Protocol protocol = testing::with_blocks({"test", "b"}, own_orders);
  std::vector<results::SessionRow> sessions;
  std::set<std::string> participants;
  for (int order_index = 0; order_index < 4; ++order_index) {
    results::SessionRow& session = sessions.emplace_back();
    session.participant_id = "P" + std::to_string(order_index);
    session.order_index = order_index;
    session.group.emplace();
    session.group->name = protocols::group_of(protocol, order_index)->name;
    participants.insert(session.participant_id);
  }
  const std::string text =
      runner::describe_procedure(protocol, sessions, participants,
                                 {{"test", {.participants = participants, .answered = 10}},
                                  {"b", {.participants = participants, .answered = 12}}})
          .words;
  INFO(text);
  for (const char* const words :
       {"'own' (n = 2) did 'test', 'b', in the order 'b', 'test', presented of 'test' "
        "'acrylic_two', 'mdf_two'; 'other' (n = 2)",
        "'test' (identification of 3 stimuli, of which groups were presented their own, 2 to 3 "
        "trials",
        "Each group did these blocks, in this order where it has none of its own: 'test'",
        "of groups without an order of their own"}) {
    INFO(words);
    CHECK(text.find(words) != std::string::npos);
  }
  // 2 × 2 and 2 × 3 trials are all that there are
  CHECK(text.find("of 10 answers given") == std::string::npos);
}

TEST_CASE("the order of a block is drawn again from the stimuli of the participant's group",
          "[runner][report]") {
  const protocols::Protocol protocol = testing::with_blocks({"test", "b"}, own_orders);
  const auto design = runner::design_of(protocol, results::Mode::simulated);
  REQUIRE(design.blocks.front().redraw);
  for (int i = 0; i < 8; ++i) {
    std::multiset<std::string> planned;
    for (const std::string& name :
         testing::stimuli_of("test", protocols::make_schedule(protocol, 1, i))) {
      planned.insert(name);
    }
    std::multiset<std::string> redrawn;
    for (const int place : design.blocks.front().redraw({i, i}, 77)) {
      redrawn.insert(design.blocks.front().stimuli.at(static_cast<std::size_t>(place)).name);
    }
    CHECK(redrawn == planned);
  }
}
