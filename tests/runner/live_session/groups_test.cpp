#include "protocols/schedule/groups.hpp"

#include <map>
#include <set>

#include "core/error.hpp"
#include "results/journal/journal.hpp"
#include "runner/live_session/live_session.hpp"
#include "runner/session/devices/rigs.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/studies/study_verification.hpp"
#include "support/blocks.hpp"
#include "support/stored_study.hpp"
using namespace tapstudy;
using testing::Names;

namespace {
// A study of two groups, of whose participants each answers one trial.
class Laboratory {
 public:
  runner::BegunSession begin(const std::string& participant, const std::string& group = "",
                             runner::Resume resume = runner::Resume::no,
                             std::optional<int> order_index = {}) {
    runner::SessionRequest request;
    request.participant_id = participant;
    request.resume = resume;
    request.seed = resume == runner::Resume::yes ? std::optional<std::uint64_t>{} : 7;
    request.group = group;
    request.order_index = order_index;
    runner::BegunSession session =
        begin_session(request, protocol, runner::simulated_rig(), {}, store);
    if (resume == runner::Resume::no) {
      results::TrialRecord record = testing::small_study::trial(session.row.id, 1, "mdf_two");
      record.trial.block = "test";
      store.add_trial(record);
    }
    return session;
  }
  std::string group_of(const std::string& participant) {
    return store.latest_session(participant)->group->name;
  }

  const testing::TempDirectory directory;
  const protocols::Protocol protocol = testing::with_blocks(
      {"test", "training", "retest"},
      "block_order: {order: williams}\n"
      "groups:\n  - {name: trained}\n  - {name: untrained, blocks: [test, retest]}\n");
  results::Store store = results::Store::open_or_create(directory / "study",
                                                        runner::study_row(protocol, "study.yaml"));
};
}  // namespace

TEST_CASE("participants are dealt to groups in runs of one of each, and it is stored",
          "[runner][groups]") {
  Laboratory laboratory;
  std::map<std::string, int> count;
  for (int i = 0; i < 8; ++i) {
    const auto session = laboratory.begin("P" + std::to_string(i));
    REQUIRE(session.row.group);
    CHECK_FALSE(session.row.group->is_given);
    CHECK(session.row.group->name == protocols::group_of(laboratory.protocol, i)->name);
    ++count[session.row.group->name];
    if (i % 2 == 1) {
      CHECK(count["trained"] == count["untrained"]);
    }
    const std::set<std::string> planned = [&] {
      std::set<std::string> blocks;
      for (const auto& [block, number] : protocols::first_trials(session.row.planned_order)) {
        blocks.insert(block);
      }
      return blocks;
    }();
    CHECK(planned.contains("training") == (session.row.group->name == "trained"));
  }
}

// The law: a group that is given takes the first unused order index of that group. The group of an
// index never changes, so that all participants together are as balanced as without it.
TEST_CASE("a group that is given leaves every other order index in the group that it had",
          "[runner][groups]") {
  Laboratory laboratory;
  Names given{"trained", "trained", "", "untrained", "", "trained", "", "", ""};
  std::set<int> used;
  for (std::size_t i = 0; i < given.size(); ++i) {
    int expected = 0;
    while (used.contains(expected) ||
           (!given[i].empty() &&
            protocols::group_of(laboratory.protocol, expected)->name != given[i])) {
      ++expected;
    }
    const auto session = laboratory.begin("P" + std::to_string(i), given[i]);
    CHECK(session.row.order_index == expected);
    CHECK(session.row.group->name == protocols::group_of(laboratory.protocol, expected)->name);
    CHECK(session.row.group->is_given == !given[i].empty());
    used.insert(expected);
  }
  std::map<std::string, int> count;
  for (std::size_t i = 0; i < given.size(); ++i) {
    ++count[laboratory.group_of("P" + std::to_string(i))];
  }
  CHECK(std::abs(count["trained"] - count["untrained"]) == 1);
}

TEST_CASE("who resumes keeps group, blocks and their order, however the group was assigned",
          "[runner][groups]") {
  Laboratory laboratory;
  const std::string group = GENERATE("", "trained", "untrained");
  laboratory.begin("P1");
  const auto begun = laboratory.begin("P2", group);
  laboratory.begin("P3");
  const auto resumed = laboratory.begin("P2", "", runner::Resume::yes);
  CHECK(resumed.row.group == begun.row.group);
  CHECK(resumed.row.planned_order == begun.row.planned_order);
  CHECK(described(resumed.schedule) == begun.row.planned_order);
  CHECK_NOTHROW(laboratory.begin("P2", begun.row.group->name, runner::Resume::yes));
  const std::string other = begun.row.group->name == "trained" ? "untrained" : "trained";
  CHECK_THROWS_WITH(laboratory.begin("P2", other, runner::Resume::yes), Contains("keeps it"));
}

TEST_CASE("a group that cannot be given is refused, and says which can", "[runner][groups]") {
  Laboratory laboratory;
  CHECK_THROWS_WITH(laboratory.begin("P1", "wild"),
                    Contains("--group") && Contains("trained, untrained"));
  const std::string first = protocols::group_of(laboratory.protocol, 0)->name;
  CHECK_THROWS_WITH(
      laboratory.begin("P1", first == "trained" ? "untrained" : "trained", runner::Resume::no, 0),
      Contains("--row") && Contains(first));
  CHECK(laboratory.begin("P1", first, runner::Resume::no, 0).row.order_index == 0);
}

TEST_CASE("verification notices a group that was changed, and how it was assigned",
          "[runner][groups]") {
  Laboratory laboratory;
  const auto drawn = laboratory.begin("P1");
  const std::string& other = drawn.row.group->name == "trained" ? "untrained" : "trained";
  laboratory.begin("P2", drawn.row.group->name);
  const auto findings = [&] {
    const auto found = runner::verification_of(laboratory.store, laboratory.directory / "study");
    Names all = found.broken;
    all.insert(all.end(), found.study_and_sessions.begin(), found.study_and_sessions.end());
    return all;
  };
  const Names before = findings();
  for (const std::string& change :
       Names{"group_name = '" + other + "'", "group_name = 'wild'", "group_assignment = 'given'",
             "group_name = NULL, group_assignment = NULL", "order_index = order_index + 1",
             "order_index = order_index + 2"}) {
    INFO(change);
    laboratory.store.query("BEGIN").finish();
    laboratory.store.query("UPDATE participant SET " + change + " WHERE participant_id = 'P1'")
        .finish();
    CHECK(findings() != before);
    laboratory.store.query("ROLLBACK").finish();
  }
  CHECK(findings() == before);
  // with the journal changed as well, the place still tells the group
  laboratory.store
      .query("UPDATE participant SET group_name = '" + other + "' WHERE participant_id = 'P1'")
      .finish();
  const auto found = runner::verification_of(laboratory.store, laboratory.directory / "study");
  CHECK(std::ranges::any_of(found.broken, [](const std::string& line) {
    return line.find("order_index 0 is of group") != std::string::npos;
  }));
}

TEST_CASE("a study rebuilt from its journal has the groups", "[runner][groups]") {
  Laboratory laboratory;
  laboratory.begin("P1", "untrained");
  laboratory.begin("P2");
  results::Store rebuilt = results::Store::from_journal(laboratory.directory / "study");
  for (const char* const participant : {"P1", "P2"}) {
    CHECK(rebuilt.latest_session(participant)->group ==
          laboratory.store.latest_session(participant)->group);
  }
}

TEST_CASE("somebody whose id reads like another's is asked about", "[runner]") {
  Laboratory laboratory;
  laboratory.begin("P01");
  for (const char* const id : {"P1", "p01", "p1", "P001"}) {
    CHECK_THROWS_WITH(laboratory.begin(id), Contains("this study has a 'P01', which reads alike"));
  }
  CHECK_THROWS_WITH(laboratory.begin("P1", "", runner::Resume::yes),
                    Contains("has no session to resume ('P01' has)"));
  for (const char* const id : {"P10", "P11", "01", "P0-1"}) {
    CHECK_NOTHROW(laboratory.begin(id));
  }
  CHECK_NOTHROW(laboratory.begin("P01", "", runner::Resume::yes));
}
