#include <map>
#include <set>

#include "core/error.hpp"
#include "protocols/schedule/ordering.hpp"
#include "protocols/schedule/schedule.hpp"
#include "support/blocks.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
using testing::Names;

namespace {
constexpr const char* three_days =
    "block_order: {order: williams}\n"
    "sessions:\n  - {name: day_1, blocks: [practice, hard, soft]}\n"
    "  - {name: day_2, blocks: [soft, hard, long], min_hours_since_last: 20}\n"
    "  - {name: later, blocks: [hard], min_days_since_last: 6, max_days_since_last: 8}\n";

Names session_of_trials(const protocols::Protocol& protocol, const protocols::Schedule& schedule) {
  Names sessions;
  for (const auto& trial : schedule) {
    sessions.push_back(protocol.block(trial.block).session);
  }
  sessions.erase(std::unique(sessions.begin(), sessions.end()), sessions.end());
  return sessions;
}
}  // namespace

TEST_CASE("a block of several sessions is one of each, called after both", "[protocols][days]") {
  const auto protocol = testing::with_blocks({"practice", "hard", "soft", "long"}, three_days);
  Names names;
  Names measures;
  for (const auto& block : protocol.blocks) {
    names.push_back(block.name);
    measures.push_back(block.measure);
  }
  CHECK(names == Names{"practice", "hard.day_1", "soft.day_1", "hard.day_2", "soft.day_2", "long",
                       "hard.later"});
  CHECK(measures == Names{"practice", "hard", "soft", "hard", "soft", "long", "hard"});
  CHECK(protocol.sessions[1].blocks == Names{"hard.day_2", "soft.day_2", "long"});
  CHECK(protocol.sessions[1].min_since_last_s == 20 * 3600.0);
  CHECK(protocol.sessions[2].min_since_last_s == 6 * 86400.0);
  CHECK(protocol.sessions[2].max_since_last_s == 8 * 86400.0);
  const auto grouped =
      testing::with_blocks({"practice", "hard", "soft", "long"},
                           std::string{three_days} +
                               "groups:\n  - {name: all, blocks: [practice, hard, soft, long]}\n"
                               "  - {name: some, blocks: [hard.day_1, soft]}\n");
  CHECK(grouped.groups[0].blocks == names);
  CHECK(grouped.groups[1].blocks == Names{"hard.day_1", "soft.day_1", "soft.day_2"});
}

TEST_CASE("an order of blocks of which no two are of one session is refused", "[protocols][days]") {
  const std::string two_days =
      "sessions:\n  - {name: day_1, blocks: [hard]}\n  - {name: day_2, blocks: [soft, long]}\n";
  CHECK_THROWS_WITH(
      testing::with_blocks({"hard", "soft", "long"},
                           "block_order: {order: williams, blocks: [hard, soft]}\n" + two_days),
      Contains("no two of its blocks are of one session"));
  CHECK_NOTHROW(testing::with_blocks({"hard", "soft", "long"},
                                     "block_order: {order: williams}\n" + two_days));
}

// Blocks exchange their places within a session only, and there in the rows of a Williams design.
TEST_CASE("sessions follow one another in every order, and each is balanced by itself",
          "[protocols][days]") {
  const auto protocol = testing::with_blocks({"practice", "hard", "soft", "long"}, three_days);
  const int orders = protocols::balanced_block_orders(protocol, nullptr);
  CHECK(orders == 6);  // of 2 blocks there are 2 rows, of 3 there are 6
  std::map<Names, int> of_day_1;
  std::map<Names, int> of_day_2;
  for (int i = 0; i < orders; ++i) {
    const auto schedule = make_schedule(protocol, 7, i);
    CHECK(session_of_trials(protocol, schedule) == Names{"day_1", "day_2", "later"});
    std::size_t trials = 0;
    for (const auto& session : protocol.sessions) {
      trials += trials_of_session(schedule, protocol, session.name).size();
    }
    CHECK(trials == schedule.size());
    for (std::size_t t = 0; t < schedule.size(); ++t) {
      CHECK(schedule[t].number == static_cast<int>(t) + 1);
    }
    Names blocks;
    for (const std::size_t b : protocols::block_sequence(protocol, 7, i)) {
      blocks.push_back(protocol.blocks[b].name);
    }
    CHECK(blocks.front() == "practice");
    ++of_day_1[{blocks[1], blocks[2]}];
    ++of_day_2[{blocks[3], blocks[4], blocks[5]}];
  }
  CHECK(of_day_1 ==
        std::map<Names, int>{{{"hard.day_1", "soft.day_1"}, 3}, {{"soft.day_1", "hard.day_1"}, 3}});
  CHECK(of_day_2.size() == 6);
}

TEST_CASE("sessions that cannot be are refused, and say what can", "[protocols][days]") {
  const auto [sessions, message] = GENERATE(
      std::pair{"[{name: one, blocks: [hard, soft]}]", "must be two or more"},
      std::pair{"[{name: one, blocks: [hard]}, {name: two, blocks: [hard]}]",
                "block 'soft' is in none of them"},
      std::pair{"[{name: one, blocks: [hard]}, {name: one, blocks: [soft]}]",
                "is the name of an earlier session"},
      std::pair{"[{name: one, blocks: [hard], min_days_since_last: 1}, {name: two, blocks: "
                "[soft]}]",
                "but is the first"},
      std::pair{"[{name: one, blocks: [hard]}, {name: two, blocks: [soft], min_days_since_last: "
                "1, min_hours_since_last: 20}]",
                "stands beside min_hours_since_last"},
      std::pair{"[{name: one, blocks: [hard]}, {name: two, blocks: [soft], min_days_since_last: "
                "2, max_hours_since_last: 47}]",
                "ends before it begins"},
      std::pair{"[{name: one, blocks: [hard, soft]}, {name: two, blocks: [sof]}]", "soft"},
      std::pair{"[{name: day, blocks: [hard, soft]}, {name: day.hard, blocks: [hard.day]}]",
                "not a known block"});
  CHECK_THROWS_WITH(testing::with_blocks({"hard", "soft"}, fmt::format("sessions: {}\n", sessions)),
                    Contains(message));
}
