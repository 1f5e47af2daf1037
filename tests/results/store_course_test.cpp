#include <string>
#include <vector>

#include "results/participant_courses.hpp"
#include "results/store.hpp"
#include "support/catch.hpp"
#include "support/python_program.hpp"
#include "support/small_study.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace tapstudy::results;

namespace {
// Every status, repeated attempts, a second session, catch trials, corrections, masking, forms.
void add_eventful_session(Store& store, const std::string& participant, int offset) {
  SessionRow session = testing::small_study::session(participant);
  session.participant_index = participant == "P01" ? 0 : 1;
  store.add_session(session);
  using enum TrialStatus;
  const std::vector<TrialStatus> statuses{answered,  interrupted, repeated, timed_out,
                                          timed_out, skipped,     answered, answered};
  for (std::size_t i = 0; i < statuses.size(); ++i) {
    const int number = offset + static_cast<int>(i);
    TrialRecord record = testing::small_study::trial(session.id, number, i % 2 == 0 ? "a" : "b");
    record.trial.status = statuses[i];
    record.trial.is_catch = i >= 6;
    record.trial.is_practice = i == 0;
    if (record.trial.status != answered) {
      record.response.reset();
    }
    record.statistics = {100 + number, 7, 3, 2, 1, 1e-4 * number, 1e-3 * number, ""};
    record.events.push_back({0.1, "impact", 0.2});
    record.events.push_back({0.2, "masking", -30.0 - number});
    record.events.push_back({0.3, "masking_underrun", 2.0});
    if (i % 3 == 0) {
      record.events.push_back({0.1, "late_impact", 0.2});
    }
    store.add_trial(record);
  }
  TrialRecord again = testing::small_study::trial(session.id, offset + 3, "a");
  again.trial.attempt = 2;  // what timed out is answered later
  store.add_trial(again);
  store.add_correction({session.id, offset + 6, "b", false, GivenBy::participant},
                       {session.id, 1.0, "correct", offset + 6, "b"});
  store.add_form({{session.id, 1.0, "about", "session begin" + std::to_string(offset), "hand", "l"},
                  {session.id, 1.0, "about", "session begin" + std::to_string(offset), "age", {}}});
}

std::vector<double> counted_by_python(const std::string& database) {
  return testing::python_numbers(R"py(
import sqlite3
db = sqlite3.connect(")py" + database +
                                 R"py(")
db.row_factory = sqlite3.Row
rows = lambda table: [dict(r) for r in db.execute("SELECT * FROM " + table)]
sessions, trials, ticks = rows("session"), rows("trial"), rows("tick_statistics")
responses, events, forms = rows("response"), rows("event"), rows("form_answer")
superseded = {r["supersedes"] for r in responses}
now = {r["trial_id"]: r for r in responses if r["response_id"] not in superseded}
for person in sorted({s["participant_id"] for s in sessions}):
  mine = [s["session_id"] for s in sessions if s["participant_id"] == person]
  own = [t for t in trials if t["session_id"] in mine]
  planned = [t for t in own if not t["is_practice"]]
  answered = [t for t in planned if t["status"] == "answered"]
  done = {t["number"] for t in answered}
  status = lambda s: sum(t["status"] == s for t in planned)
  out(len(mine), status("answered"), status("interrupted"), status("repeated"),
      status("skipped"), status("timed_out"),
      len({t["number"] for t in planned if t["status"] in ("skipped", "timed_out")} - done),
      sum(now[t["trial_id"]]["supersedes"] is not None for t in answered),
      sum(t["is_catch"] for t in answered),
      sum(t["is_catch"] and now[t["trial_id"]]["is_correct"] for t in answered))
  asked = [f for f in forms if f["session_id"] in mine]
  out(len(asked), sum(f["answer"] is None for f in asked))
  ids = {t["trial_id"] for t in own}
  loop = [t for t in ticks if t["trial_id"] in ids]
  for name in ("ticks", "late", "skipped", "saturated", "dropped_samples"):
    out(sum(t[name] for t in loop))
  out(max(t["lateness_p999_s"] for t in loop), max(t["worst_lateness_s"] for t in loop))
  of = lambda kind: [e["value"] for e in events if e["trial_id"] in ids and e["kind"] == kind]
  out(len(of("impact")), len(of("late_impact")), len(of("masking")), min(of("masking")),
      max(of("masking")), sum(of("masking_underrun")))
)py");
}

std::vector<double> counted_by_store(Store& store) {
  std::vector<double> all;
  const auto add = [&](auto... values) { (all.push_back(static_cast<double>(values)), ...); };
  for (const ParticipantCourseRow& row : participant_courses(store)) {
    add(row.sessions, row.answered, row.interrupted, row.repeated, row.skipped, row.timed_out,
        row.given_up, row.corrected, row.catch_trials, row.catch_right, row.form_items,
        row.form_items_left_out, row.ticks, row.late, row.skipped_ticks, row.saturated,
        row.dropped_samples, row.lateness_p999_s, row.worst_lateness_s, row.impacts,
        row.late_impacts, row.masked_trials, row.masking_low_db.value(),
        row.masking_high_db.value(), row.masking_gaps);
  }
  return all;
}
}  // namespace

TEST_CASE("how a participant's sessions went is what python3 counts in the raw tables",
          "[results][store][course]") {
  const testing::TempDirectory directory;
  Store store = Store::open_or_create(directory.path(), testing::small_study::study);
  add_eventful_session(store, "P01", 1);
  add_eventful_session(store, "P01", 21);
  add_eventful_session(store, "P02", 1);
  const std::vector<double> expected = counted_by_python(directory / "study.db");
  const std::vector<double> found = counted_by_store(store);
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    INFO("value " << i);
    CHECK(found[i] == Approx(expected[i]));
  }
}

TEST_CASE("a participant without a trial is named with nothing done, and why who was excluded",
          "[results][store][course]") {
  const testing::TempDirectory directory;
  auto [store, session] = testing::small_study::begun_study(directory.path());
  store.add_operator_action({session.id, 1.0, "exclude", {}, "fell asleep"});
  const auto courses = participant_courses(store);
  REQUIRE(courses.size() == 1);
  CHECK(courses[0].sessions == 1);
  CHECK(courses[0].answered == 0);
  CHECK(courses[0].ticks == 0);
  CHECK_FALSE(courses[0].masking_low_db);
  CHECK(courses[0].exclusion_reason == "fell asleep");
}

TEST_CASE(
    "what was done of a block counts answers and masked ones, of those whose answers are reported",
    "[results][store][course]") {
  const testing::TempDirectory directory;
  Store store = Store::open_or_create(directory.path(), testing::small_study::study);
  add_eventful_session(store, "P01", 1);
  add_eventful_session(store, "P02", 1);
  SessionRow begun = testing::small_study::session("P03");  // who answered nothing
  begun.participant_index = 2;
  store.add_session(begun);
  const auto done = [&] { return block_courses(store, Mode::real); };
  const std::string block = testing::small_study::trial(1, 1, "a").trial.block;
  CHECK(block_courses(store, Mode::pilot).empty());
  REQUIRE(done().contains(block));
  CHECK(done().at(block).participants == std::set<std::string>{"P01", "P02"});
  CHECK(done().at(block).answered == 8);  // of each: three of eight, and one answered later
  CHECK(done().at(block).masked == 6);
  store.add_operator_action({1, 1.0, "exclude", {}, "fell asleep"});
  CHECK(done().at(block).participants == std::set<std::string>{"P02"});
  CHECK(done().at(block).answered == 4);
}
