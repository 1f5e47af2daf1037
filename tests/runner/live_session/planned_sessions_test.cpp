#include "runner/session/engine/planned_sessions.hpp"

#include <set>

#include "core/error.hpp"
#include "results/journal/journal.hpp"
#include "results/store/sqlite.hpp"
#include "runner/live_session/live_session.hpp"
#include "runner/session/devices/rigs.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/studies/simulated_study.hpp"
#include "runner/studies/study_verification.hpp"
#include "support/blocks.hpp"
#include "support/stored_study.hpp"
using namespace tapstudy;
using testing::Names;

namespace {
constexpr const char* days =
    "sessions:\n  - {name: day_1, blocks: [test]}\n"
    "  - {name: day_2, blocks: [test, training], min_hours_since_last: 20, "
    "max_hours_since_last: 48}\n"
    "  - {name: retention, blocks: [test], min_days_since_last: 6}\n";
constexpr std::time_t hour = 3600;

// Of one participant, at a time that the test sets.
class VisitedLaboratory {
 public:
  runner::BegunSession begin(runner::Resume resume = runner::Resume::no, bool at_any_time = false) {
    runner::SessionRequest request;
    request.participant_id = "P1";
    request.resume = resume;
    request.at_any_time = at_any_time;
    request.now = [this] { return now; };
    return begin_session(request, protocol, runner::simulated_rig(), {}, store);
  }
  void answer(const runner::BegunSession& session, std::size_t trials) {
    for (std::size_t i = 0; i < trials; ++i) {
      const protocols::PlannedTrial& planned = session.schedule.at(i);
      if (session.done.contains(planned.number)) {
        continue;
      }
      results::TrialRecord record =
          testing::small_study::trial(session.row.id, planned.number, "mdf_two");
      record.trial.block = planned.block;
      store.add_trial(record);
    }
  }
  void complete(const runner::BegunSession& session) { answer(session, session.schedule.size()); }

  std::time_t now{1'800'000'000};  // 2027-01-15 08:00:00 UTC
  const testing::TempDirectory directory;
  const protocols::Protocol protocol = testing::with_blocks({"test", "training"}, days);
  results::Store store = results::Store::open_or_create(directory / "study",
                                                        runner::study_row(protocol, "study.yaml"));
};
}  // namespace

TEST_CASE("who has done a session does the next, of the same order, and then no more",
          "[runner][days]") {
  VisitedLaboratory laboratory;
  const auto first = laboratory.begin();
  laboratory.complete(first);
  laboratory.now += 24 * hour;
  const auto second = laboratory.begin();
  laboratory.complete(second);
  laboratory.now += 7 * 24 * hour;
  const auto third = laboratory.begin();
  laboratory.complete(third);
  CHECK(first.row.planned_session == "day_1");
  CHECK(second.row.planned_session == "day_2");
  CHECK(third.row.planned_session == "retention");
  CHECK(first.row.started_utc == "2027-01-15T08:00:00Z");
  CHECK(second.row.started_utc == "2027-01-16T08:00:00Z");
  std::set<int> numbers;
  for (const auto* session : {&first, &second, &third}) {
    CHECK_FALSE(session->row.resumes);
    CHECK(session->row.seed == first.row.seed);
    CHECK(session->row.planned_order == first.row.planned_order);
    CHECK(session->done.empty());
    CHECK(session->note.empty());
    CHECK(session->earlier.comes_again == (session != &third));
    for (const auto& trial : session->schedule) {
      CHECK(laboratory.protocol.block(trial.block).session == session->row.planned_session);
      CHECK(numbers.insert(trial.number).second);
    }
  }
  CHECK(static_cast<std::ptrdiff_t>(numbers.size()) ==
        std::count(first.row.planned_order.begin(), first.row.planned_order.end(), '\n'));
  CHECK_THROWS_WITH(laboratory.begin(), Contains("has completed every session"));
  CHECK(results::read_journal(laboratory.directory / "study").sessions[1].planned_session ==
        "day_2");
}

TEST_CASE("a session that is not done is gone on with, never passed over", "[runner][days]") {
  VisitedLaboratory laboratory;
  laboratory.complete(laboratory.begin());
  laboratory.now += 24 * hour;
  const auto begun = laboratory.begin();
  laboratory.answer(begun, 2);
  laboratory.now += 30 * 24 * hour;  // however long that takes
  CHECK_THROWS_WITH(laboratory.begin(), Contains("trials left in session 'day_2' (go on with"));
  const auto resumed = laboratory.begin(runner::Resume::yes);
  CHECK(resumed.row.planned_session == "day_2");
  CHECK(resumed.row.resumes == begun.row.id);
  CHECK(resumed.schedule.size() == begun.schedule.size());
  CHECK(resumed.done.size() == 2);
  laboratory.complete(resumed);
  // since the last time that the participant was there
  CHECK_THROWS_WITH(laboratory.begin(), Contains("6 days too early"));
}

TEST_CASE("a session that is resumed with nothing left does not move the day of the next one",
          "[runner][days]") {
  VisitedLaboratory laboratory;
  laboratory.complete(laboratory.begin());
  laboratory.now += 24 * hour;
  CHECK(laboratory.begin(runner::Resume::yes).done.size() ==
        laboratory.begin(runner::Resume::yes).schedule.size());
  laboratory.now += hour;
  const auto next = laboratory.begin();
  CHECK(next.row.planned_session == "day_2");
  CHECK(next.note.empty());
}

TEST_CASE("too early or too late is refused with when it may be, or noted", "[runner][days]") {
  VisitedLaboratory laboratory;
  laboratory.complete(laboratory.begin());
  const std::time_t began = laboratory.now;
  const auto [seconds, refusal] = GENERATE(
      std::pair{std::time_t{20 * hour - 1}, "from 2027-01-16 04:00 UTC and until 2027-01-17 08:00"},
      std::pair{std::time_t{19 * hour}, "1 h too early"}, std::pair{std::time_t{20 * hour}, ""},
      std::pair{std::time_t{48 * hour}, ""}, std::pair{std::time_t{50 * hour}, "2 h too late"});
  laboratory.now = began + seconds;
  if (*refusal == '\0') {
    CHECK(laboratory.begin().note.empty());
    return;
  }
  CHECK_THROWS_WITH(laboratory.begin(),
                    Contains(refusal) && Contains("20 h to 48 h after session"));
  CHECK(laboratory.store.sessions().size() == 1);
  const auto begun = laboratory.begin(runner::Resume::no, true);
  CHECK(begun.row.planned_session == "day_2");
  const auto actions = results::read_journal(laboratory.directory / "study").entries.actions;
  REQUIRE(actions.size() == 1);
  CHECK(actions[0].session_id == begun.row.id);
  CHECK(actions[0].action == "note");
  CHECK_THAT(actions[0].detail, Contains("--any-time"));
}

namespace {
// Whose plates vibrate in no stimulus, so that nothing is solved.
protocols::Protocol quick(const std::string& keys) {
  std::string text = testing::text_with_blocks({"test", "training"}, keys);
  for (auto at = text.find("technique: fem"); at != std::string::npos;
       at = text.find("technique: fem")) {
    text.replace(at, 14, "technique: none");
  }
  return protocols::parse_protocol(text, "study.yaml");
}
}  // namespace

TEST_CASE("a simulated participant comes to every session, and verify finds each as planned",
          "[runner][days]") {
  const testing::TempDirectory directory;
  const auto protocol = quick(days);
  runner::simulate({.protocol_file = "study.yaml",
                    .directory = directory.path(),
                    .participants = 2,
                    .seed = 3,
                    .keeps_traces = false,
                    .threads = 1},
                   protocol);
  {
    results::Store store = results::Store::open_existing(directory.path());
    Names planned;
    for (const auto& session : store.sessions()) {
      planned.push_back(session.participant_id + " " + session.planned_session.value_or("-"));
    }
    CHECK(planned == Names{"sim-01 day_1", "sim-01 day_2", "sim-01 retention", "sim-02 day_1",
                           "sim-02 day_2", "sim-02 retention"});
    CHECK(store.answered_trials("sim-01").size() == make_schedule(protocol, 3, 0).size());
    const auto found = runner::verification_of(store, directory.path());
    CHECK(found.broken == Names{});
    CHECK(found.is_sound());
  }
  {
    results::Database database{directory.path() + "/study.db", results::Database::Access::write};
    database.run("UPDATE session SET planned_session = 'retention' WHERE session_id = 2");
  }
  results::Store store = results::Store::open_existing(directory.path());
  const auto broken = runner::verification_of(store, directory.path()).broken;
  REQUIRE_FALSE(broken.empty());
  CHECK_THAT(broken[0], Contains("session 2 is stored as session 'retention'"));
}
