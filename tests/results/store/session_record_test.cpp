#include <filesystem>
#include <string>
#include <vector>

#include "results/store/store.hpp"
#include "results/store/study_queries.hpp"
#include "results/store_error.hpp"
#include "support/catch.hpp"
#include "support/reference_programs.hpp"
#include "support/stored_study.hpp"
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
  out(sum(t["skipped"] > 0.01 * (t["ticks"] + t["skipped"]) for t in loop
          if any(o["trial_id"] == t["trial_id"] and o["status"] == "answered" for o in own)))
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
        row.dropped_samples, row.incomplete_trials, row.lateness_p999_s, row.worst_lateness_s,
        row.impacts, row.late_impacts, row.masked_trials, row.masking_low_db.value(),
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

// Corrections, exclusions, and who gets which of the balanced orders.
namespace small_study = testing::small_study;
using small_study::begun_study;

namespace {
OperatorActionRow action(std::int64_t session_id, const std::string& name,
                         const std::string& detail) {
  return {session_id, 1.0, name, std::nullopt, detail};
}

SessionRow add_participant(Store& store, const std::string& id,
                           const Store::OtherParticipants& others) {
  SessionRow row = small_study::session(id);
  row.planned_order = "1 main 1 a\n2 main 1 b\n";
  const Store::Place place = store.place_of(id, Mode::real, others);
  row.participant_index = place.participant_index;
  row.order_index = place.order_index;
  store.add_session(row);
  return row;
}
}  // namespace

TEST_CASE("a correction supersedes an answer, which stays in the store", "[results][store]") {
  const testing::TempDirectory directory;
  const bool is_from_journal = GENERATE(false, true);
  {
    auto [store, row] = begun_study(directory.path());
    store.add_trial(small_study::trial(row.id, 1, "a"));
    for (const char* const response : {"b", "c"}) {
      store.add_correction({row.id, 1, response, true}, action(row.id, "correct", response));
    }
    CHECK_THROWS_AS(store.add_correction({row.id, 2, "b", true}, action(row.id, "correct", "b")),
                    StoreError);
  }
  if (is_from_journal) {
    std::filesystem::remove(directory / "study.db");
  }
  Store store = is_from_journal ? Store::from_journal(directory.path())
                                : Store::open_existing(directory.path());
  REQUIRE(results::stored_answers(store).size() == 1);
  CHECK(results::stored_answers(store).front().response == "c");
  CHECK(results::stored_answers(store).front().is_correct == true);
  const JournalEntries entries = store.entries_for_journal();
  CHECK(entries.answers.front().response.response == "a");
  CHECK(entries.corrections.size() == 2);
  CHECK(entries.actions.size() == 2);  // none of the one refused
}

TEST_CASE("what was not as planned is counted for each participant", "[results][store]") {
  const testing::TempDirectory directory;
  auto [store, row] = begun_study(directory.path());
  store.add_trial(small_study::trial(row.id, 1, "b"));  // a was right
  store.add_trial(small_study::trial(row.id, 2, "a"));
  auto skipped = small_study::trial(row.id, 3, "a");
  skipped.response.reset();
  skipped.trial.status = results::TrialStatus::skipped;
  store.add_trial(skipped);
  for (const char* const response : {"c", "a"}) {
    store.add_correction({row.id, 1, response, response == std::string{"a"}},
                         action(row.id, "correct", response));
  }
  const auto courses = results::participant_courses(store);
  REQUIRE(courses.size() == 1);
  CHECK(courses.front().corrected == 1);  // one answer, twice
  CHECK(courses.front().corrected_to_right == 1);
  CHECK(courses.front().skipped == 1);
  CHECK(courses.front().timed_out == 0);
}

TEST_CASE("the last word on a participant's exclusion holds", "[results][store]") {
  const testing::TempDirectory directory;
  auto [store, row] = begun_study(directory.path());
  store.add_operator_action(action(row.id, "exclude", "asleep"));
  CHECK(store.excluded_participants() == std::map<std::string, std::string>{{"P01", "asleep"}});
  store.add_operator_action(action(row.id, "include", ""));
  CHECK(store.excluded_participants().empty());
}

TEST_CASE("a correction that is made again is another one, in the journal too",
          "[results][store]") {
  const testing::TempDirectory directory;
  auto [store, row] = begun_study(directory.path());
  store.add_trial(small_study::trial(row.id, 1, "a"));
  double t_s = 1.0;  // no two actions are of one time
  for (const char* const response : {"b", "a", "b"}) {
    store.add_correction({row.id, 1, response, true},
                         {row.id, t_s++, "correct", std::nullopt, response});
  }
  const JournalEntries journalled = read_journal(directory.path()).entries;
  REQUIRE(journalled.corrections.size() == 3);
  CHECK(journalled.corrections.back().response == "b");
  CHECK(to_lines(journalled).size() == 1 + 3 + 3);  // the answer, corrections and actions
  CHECK(to_lines({.corrections = journalled.corrections}) ==
        to_lines({.corrections = store.entries_for_journal().corrections}));
}

TEST_CASE("what the journal could not take is made up for, not doubled", "[results][store]") {
  const testing::TempDirectory directory;
  auto [store, row] = begun_study(directory.path());
  const std::string journal = directory / "answers.journal";
  std::filesystem::remove(journal);
  std::filesystem::create_directory(journal);  // so that it cannot be opened
  const std::vector<FormAnswerRow> form{{row.id, 1.0, "about", "main", "hand", "left"}};
  CHECK_THROWS_AS(store.add_form(form), StoreError);
  std::filesystem::remove(journal);
  store.add_form(form);
  CHECK(store.entries_for_journal().form_answers.size() == 1);
  CHECK(read_journal(directory.path()).entries.form_answers.size() == 1);
}

TEST_CASE(
    "a questionnaire that the journal could not take can be saved again after an operator's note",
    "[results][store]") {
  const testing::TempDirectory directory;
  auto [store, row] = begun_study(directory.path());
  const std::string journal = directory / "answers.journal";
  std::filesystem::remove(journal);
  std::filesystem::create_directory(journal);
  const std::vector<FormAnswerRow> form{{row.id, 1.0, "about", "main", "hand", "left"}};
  CHECK_THROWS_AS(store.add_form(form), StoreError);
  CHECK_THROWS_AS(store.add_operator_action(action(row.id, "note", "disk full")), StoreError);
  std::filesystem::remove(journal);
  store.add_operator_action(action(row.id, "resume", ""));
  store.add_form(form);
  store.add_form({{row.id, 2.0, "about", "end", "hand", "right"}});
  const JournalEntries journalled = read_journal(directory.path()).entries;
  CHECK(to_lines(journalled) == to_lines(store.entries_for_journal()));
  CHECK(journalled.form_answers.size() == 2);
  CHECK(journalled.actions.size() == 2);
}

TEST_CASE("a journal that was deleted or cut off in a session is whole again after the next answer",
          "[results][store]") {
  const testing::TempDirectory directory;
  auto [store, row] = begun_study(directory.path());
  const std::string journal = directory / "answers.journal";
  store.add_trial(small_study::trial(row.id, 1, "a"));
  std::filesystem::remove(journal);
  store.add_trial(small_study::trial(row.id, 2, "b"));
  CHECK(to_lines(read_journal(directory.path()).entries) == to_lines(store.entries_for_journal()));
  std::filesystem::resize_file(journal, std::filesystem::file_size(journal) / 2);
  store.add_operator_action(action(row.id, "note", "who was here?"));
  CHECK(to_lines(read_journal(directory.path()).entries) == to_lines(store.entries_for_journal()));
}

TEST_CASE(
    "a balanced order is used up by who has answered, or is in a session, and has neither been "
    "excluded nor withdrawn",
    "[results][store]") {
  const testing::TempDirectory directory;
  Store store = Store::open_or_create(directory.path(), small_study::study);
  bool has_trials_left = true;
  const Store::OtherParticipants is_p02{[](const std::string& id) { return id == "P02"; },
                                        [&](const std::string& /*id*/) { return has_trials_left; }};
  const SessionRow killed = add_participant(store, "P01", is_p02);
  const SessionRow active = add_participant(store, "P02", is_p02);
  CHECK(active.order_index == killed.order_index);  // who was never asked anything keeps no order
  const SessionRow answered = add_participant(store, "P03", is_p02);
  CHECK(answered.order_index == 1);
  store.add_trial(small_study::trial(answered.id, 1, "a"));
  const SessionRow excluded = add_participant(store, "P04", is_p02);
  CHECK(excluded.order_index == 2);
  store.add_trial(small_study::trial(excluded.id, 1, "a"));
  store.add_operator_action(action(excluded.id, "exclude", "asleep"));
  const SessionRow withdrawn = add_participant(store, "P05", is_p02);
  CHECK(withdrawn.order_index == 2);
  store.add_trial(small_study::trial(withdrawn.id, 7, "a"));
  CHECK(add_participant(store, "P06", is_p02).order_index == 3);
  CHECK(store.place_of("P07", Mode::real, is_p02).order_index == 3);  // P06 answered nothing
  store.add_operator_action(action(withdrawn.id, "end", "went home"));
  CHECK(store.place_of("P07", Mode::real, is_p02).order_index == 2);
  has_trials_left = false;  // ended after the last trial: nobody withdrew
  CHECK(store.place_of("P07", Mode::real, is_p02).order_index == 3);
  CHECK(store.place_of("P03", Mode::real, is_p02).order_index == 1);  // if resumed
  CHECK(store.place_of("Q01", Mode::pilot, is_p02).order_index == 0);
}
