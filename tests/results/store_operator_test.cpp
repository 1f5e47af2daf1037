// Corrections, exclusions, and who gets which of the balanced orders.
#include <filesystem>

#include "results/participant_courses.hpp"
#include "results/store.hpp"
#include "results/store_error.hpp"
#include "results/stored_answers.hpp"
#include "support/catch.hpp"
#include "support/small_study.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace tapstudy::results;
namespace small_study = testing::small_study;
using small_study::begun_study;

namespace {
OperatorActionRow action(std::int64_t session_id, const std::string& name,
                         const std::string& detail) {
  return {session_id, 1.0, name, std::nullopt, detail};
}

SessionRow add_participant(Store& store, const std::string& id, const Store::Others& others) {
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
  const Store::Others is_p02{[](const std::string& id) { return id == "P02"; },
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
