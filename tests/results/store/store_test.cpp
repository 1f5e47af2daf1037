#include "results/store/store.hpp"

#include <sqlite3.h>
#include <sys/stat.h>

#include <cerrno>
#include <filesystem>

#include "core/error.hpp"
#include "core/files/sha256.hpp"
#include "results/store/recorder.hpp"
#include "results/store/study_queries.hpp"
#include "results/store_error.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/stored_study.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace tapstudy::results;
using namespace tapstudy::testing::small_study;
using tapstudy::core::sha256;
namespace fs = std::filesystem;

TEST_CASE("what is stored comes back", "[results][store]") {
  const testing::TempDirectory directory;
  {
    auto [store, row] = begun_study(directory.path());
    store.add_trial(trial(row.id, 1, "a"));
    store.add_trial(trial(row.id, 2, "b"));
  }
  Store store = Store::open_existing(directory.path());
  CHECK(store.study().protocol_text == study.protocol_text);
  const auto sessions = store.sessions();
  REQUIRE(sessions.size() == 1);
  CHECK(sessions[0].seed == 0xfedcba9876543210ULL);
  const auto answers = stored_answers(store);
  REQUIRE(answers.size() == 2);
  CHECK(answers[1].stimulus == "a");
  CHECK(answers[1].response == "b");
  CHECK(answers[1].response_time_s == 1.5);
  CHECK(store.trace(1).size() == 3);
  CHECK(store.answered_trials("P01") == std::vector<int>{1, 2});
}

TEST_CASE("a trace of another codec is refused, not misread", "[results][store]") {
  const testing::TempDirectory directory;
  {
    auto [store, row] = begun_study(directory.path());
    store.add_trial(trial(row.id, 1, "a"));
  }
  testing::run_program({"/usr/bin/sqlite3", directory / "study.db",
                        "UPDATE trace_chunk SET codec = 'tapstudy-trace/2'"});
  Store store = Store::open_existing(directory.path());
  const auto refused = Contains("is encoded as 'tapstudy-trace/2'");
  CHECK_THROWS_WITH(store.trace(1), refused);
  CHECK_THROWS_WITH(each_trace_chunk(store, [](auto, auto) {}), refused);
}

TEST_CASE("traces come by session and number, in whatever order trials were stored",
          "[results][store]") {
  const testing::TempDirectory directory;
  auto [store, row] = begun_study(directory.path());
  for (const int number : {3, 1, 2}) {
    store.add_trial(trial(row.id, number, "a"));
  }
  std::vector<std::int64_t> visited;  // an id counts what was stored
  each_trace_chunk(store, [&](std::int64_t trial_id, auto) { visited.push_back(trial_id); });
  CHECK(visited == std::vector<std::int64_t>{2, 3, 1});
}

TEST_CASE("a trial is there whole or not at all", "[results][store]") {
  const testing::TempDirectory directory;
  auto [store, row] = begun_study(directory.path());
  TrialRecord broken = trial(row.id, 1, "a");
  broken.trace.push_back(broken.trace.front());  // the same ticks twice: refused after other rows
  CHECK_THROWS_AS(store.add_trial(broken), StoreError);
  CHECK(stored_answers(store).empty());
  CHECK(store.answered_trials("P01").empty());
  store.add_trial(trial(row.id, 1, "a"));
  CHECK(stored_answers(store).size() == 1);
}

namespace {
TrialRecord without_trace(TrialRecord record) {
  record.trace.clear();
  return record;
}
}  // namespace

TEST_CASE(
    "while nothing is confirmed, a trial is there whole or not at all, and in the journal alike",
    "[results][store]") {
  const testing::TempDirectory directory;
  auto [store, row] = begun_study(directory.path());
  store.suspend_sync();
  constexpr int trials = 95;  // more than two transactions
  for (int number = 1; number <= trials; ++number) {
    store.add_trial(without_trace(trial(row.id, number, "a")));
    TrialRecord broken = trial(row.id, number + trials, "a");
    broken.trace.push_back(broken.trace.front());  // refused after other rows
    CHECK_THROWS_AS(store.add_trial(broken), StoreError);
  }
  store.resume_sync();
  CHECK(store.trials().size() == trials);
  CHECK(to_lines(read_journal(directory.path()).entries) == to_lines(store.entries_for_journal()));
}

TEST_CASE("a program that ends while nothing is confirmed leaves no answer in the journal alone",
          "[results][store]") {
  const testing::TempDirectory directory;
  {
    auto [store, row] = begun_study(directory.path());
    store.suspend_sync();
    for (int number = 1; number <= 50; ++number) {
      store.add_trial(without_trace(trial(row.id, number, "a")));
    }
  }
  Store store = Store::open_existing(directory.path());
  CHECK(store.trials().size() == 40);
  CHECK(to_lines(read_journal(directory.path()).entries) == to_lines(store.entries_for_journal()));
}

TEST_CASE("a trial cannot be stored over another", "[results][store]") {
  const testing::TempDirectory directory;
  auto [store, row] = begun_study(directory.path());
  store.add_trial(trial(row.id, 1, "a"));
  CHECK_THROWS_AS(store.add_trial(trial(row.id, 1, "b")), StoreError);
  CHECK(stored_answers(store).front().response == "a");
}

TEST_CASE("the study of another protocol is left alone", "[results][store]") {
  const testing::TempDirectory directory;
  { Store::open_or_create(directory.path(), study); }
  const StudyRow other{"another", "other.yaml", "x", sha256("x"), {}};
  CHECK_THROWS_AS(Store::open_or_create(directory.path(), other), core::InvalidInput);
  CHECK(Store::open_existing(directory.path()).study().title == "a study");
}

namespace {
int error_of_locks = 0;
int without_locks(int /*descriptor*/, int /*command*/, void* /*lock*/) {
  errno = error_of_locks;
  return -1;
}
}  // namespace

TEST_CASE("a file system that knows no locks is named, and nothing is stored on it",
          "[results][store]") {
  error_of_locks = GENERATE(EOPNOTSUPP, ENOSYS);
  const testing::TempDirectory directory;
  sqlite3_vfs* const files = sqlite3_vfs_find(nullptr);
  const auto real = files->xGetSystemCall(files, "fcntl");
  files->xSetSystemCall(files, "fcntl", reinterpret_cast<sqlite3_syscall_ptr>(without_locks));
  CHECK_THROWS_WITH(Store::open_or_create(directory.path(), study),
                    Contains("study.db: ") && Contains("knows no locks"));
  files->xSetSystemCall(files, "fcntl", real);
  CHECK(std::filesystem::file_size(directory / "study.db") == 0);
}

TEST_CASE("what is not a study is refused", "[results][store]") {
  const testing::TempDirectory directory;
  CHECK_THROWS_AS(Store::open_existing(directory.path()), core::InvalidInput);
  testing::write(directory / "study.db",
                 "this is not a database, but it is long enough to be read");
  CHECK_THROWS_AS(Store::open_or_create(directory.path(), study), StoreError);
  CHECK_THAT(testing::contents(directory / "study.db"), Contains("this is not a database"));
}

TEST_CASE("participants are counted once and keep to one mode", "[results][store]") {
  const testing::TempDirectory directory;
  Store store = Store::open_or_create(directory.path(), study);
  const auto place_of = [&](const std::string& id, Mode mode) {
    const auto nobody = [](const std::string& /*id*/) { return false; };
    return store.place_of(id, mode, {nobody, nobody});
  };
  CHECK(place_of("P01", Mode::real).participant_index == 0);
  SessionRow first = session("P01");
  store.add_session(first);
  CHECK(place_of("P01", Mode::real).participant_index == 0);
  CHECK(place_of("P02", Mode::real).participant_index == 1);
  CHECK_THROWS_AS(place_of("P01", Mode::pilot), core::InvalidInput);
}

TEST_CASE("a database deleted in a session is written anew with all that it held",
          "[results][store]") {
  const testing::TempDirectory directory;
  auto [store, row] = begun_study(directory.path());
  store.add_trial(trial(row.id, 1, "a"));
  const bool is_all_gone = GENERATE(true, false);
  for (const char* const file : {"study.db", "study.db-wal", "study.db-shm", "answers.journal"}) {
    if (is_all_gone || std::string{file} == "study.db") {
      fs::remove(directory / file);
    }
  }
  CHECK_THROWS_AS(store.add_trial(trial(row.id, 2, "a")), StoreRewritten);
  CHECK(Store::open_existing(directory.path()).answered_trials("P01") == std::vector<int>{1, 2});
}

TEST_CASE("who closes a deleted database leaves the log of the new one alone", "[results][store]") {
  const testing::TempDirectory directory;
  Store next = [&] {
    auto [store, row] = begun_study(directory.path());
    fs::remove(directory / "study.db");
    CHECK_THROWS_AS(store.add_trial(trial(row.id, 1, "a")), StoreRewritten);
    Store other = Store::open_or_create(directory.path(), study);
    SessionRow second = session("P02");
    second.participant_index = 1;
    other.add_session(second);
    return other;
  }();
  CHECK(Store::open_existing(directory.path()).sessions().size() == 2);
}

TEST_CASE("a study that was moved is said, and goes on once it is back", "[results][store]") {
  const testing::TempDirectory directory;
  const std::string here = directory / "study";
  auto [store, row] = begun_study(here);
  fs::rename(here, directory / "elsewhere");
  CHECK_THROWS_AS(store.add_trial(trial(row.id, 1, "a")), StoreError);
  fs::rename(directory / "elsewhere", here);
  CHECK(store.add_trial(trial(row.id, 1, "a")) == SaveOutcome::in_one_file);
  CHECK(Store::open_existing(here).answered_trials("P01") == std::vector<int>{1});
  CHECK(read_journal(here).entries.answers.size() == 1);
}

TEST_CASE("a copy of study.db made after any trial is whole", "[results][store]") {
  const testing::TempDirectory directory;
  auto [store, row] = begun_study(directory.path());
  for (int number = 1; number <= 3; ++number) {
    CHECK(store.add_trial(trial(row.id, number, "a")) == SaveOutcome::in_one_file);
    const std::string copy = directory / ("copy_" + std::to_string(number));
    fs::create_directory(copy);
    fs::copy_file(directory / "study.db", copy + "/study.db");
    Store copied = Store::open_existing(copy);
    CHECK(stored_answers(copied).size() == static_cast<std::size_t>(number));
  }
  Database reader{directory / "study.db", Database::Access::read};
  reader.run("BEGIN; SELECT count(*) FROM trial");
  CHECK(store.add_trial(trial(row.id, 4, "a")) == SaveOutcome::partly_in_log);
}

TEST_CASE("a database that holds what tapstudy did not put there is refused", "[results][store]") {
  const testing::TempDirectory directory;
  { Store::open_or_create(directory.path(), study); }
  const std::string sql =
      GENERATE("CREATE TRIGGER t AFTER INSERT ON response BEGIN DELETE FROM response; END",
               "CREATE VIEW v AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) "
               "SELECT * FROM n",
               "DROP TABLE event", "ALTER TABLE trial ADD COLUMN note TEXT");
  {
    Database database{directory / "study.db", Database::Access::write};
    database.run(sql);
  }
  CAPTURE(sql);
  CHECK_THROWS_AS(Store::open_existing(directory.path()), StoreError);
  CHECK_THROWS_AS(Store::open_or_create(directory.path(), study), StoreError);
}

TEST_CASE("a page that rotted is seen when the study is opened", "[results][store]") {
  const testing::TempDirectory directory;
  {
    auto [store, row] = begun_study(directory.path());
    for (int number = 1; number <= 200; ++number) {
      store.add_trial(trial(row.id, number, "a"));
    }
  }
  std::string bytes = testing::contents(directory / "study.db");
  const std::size_t page = 4096;
  REQUIRE(bytes.size() > 20 * page);
  bytes.replace(19 * page, 200, std::string(200, '\x5a'));
  testing::write(directory / "study.db", bytes);
  CHECK_THROWS_AS(Store::open_existing(directory.path()), StoreError);
}

TEST_CASE("a seed that is no whole number is refused, not read as another one",
          "[results][store]") {
  const testing::TempDirectory directory;
  { begun_study(directory.path()); }
  const std::string seed = GENERATE("", "x", "-1", "7 ", "0x7", "18446744073709551616");
  CAPTURE(seed);
  {
    Database database{directory / "study.db", Database::Access::write};
    Statement{database, "UPDATE session SET seed = ?"}.bind(seed).finish();
  }
  Store store = Store::open_existing(directory.path());
  CHECK_THROWS_WITH(store.sessions(), Contains("study.db: session 1: the seed '" + seed));
}

TEST_CASE("a pipe is no study", "[results][store]") {
  const testing::TempDirectory directory;
  REQUIRE(mkfifo((directory / "study.db").c_str(), 0600) == 0);
  CHECK_THROWS_AS(Store::open_existing(directory.path()), StoreError);
}

TEST_CASE("a trial has one answer", "[results][store]") {
  const testing::TempDirectory directory;
  {
    auto [store, row] = begun_study(directory.path());
    store.add_trial(trial(row.id, 1, "a"));
  }
  Database database{directory / "study.db", Database::Access::write};
  CHECK_THROWS_AS(database.run("INSERT INTO response (trial_id, response, response_time_s) "
                               "VALUES (1, 'b', 1.0)"),
                  StoreError);
}

TEST_CASE("a study whose database is lost is read from its journal", "[results][store]") {
  const testing::TempDirectory directory;
  {
    Store store = Store::open_or_create(directory.path(), study);
    for (const char* const participant : {"P01", "P02"}) {
      SessionRow row = session(participant);
      row.participant_index = participant == std::string{"P02"} ? 1 : 0;
      store.add_session(row);
      store.add_trial(trial(row.id, 1, "a"));
      store.add_trial(trial(row.id, 2, "b"));
    }
  }
  fs::remove(directory / "study.db");
  CHECK_THROWS_AS(Store::open_or_create(directory.path(), study), StoreError);  // not begun anew
  Store store = Store::from_journal(directory.path());
  CHECK(store.study().protocol_text == study.protocol_text);
  const auto answers = stored_answers(store);
  REQUIRE(answers.size() == 4);
  CHECK(answers[3].participant_id == "P02");
  CHECK(answers[3].response == "b");
  CHECK(answers[3].response_time_s == 1.5);
}

TEST_CASE(
    "an answer that a killed program left out of the journal is added when the study is opened",
    "[results][store]") {
  const testing::TempDirectory directory;
  {
    auto [store, row] = begun_study(directory.path());
    store.add_trial(trial(row.id, 1, "a"));
    store.add_trial(trial(row.id, 2, "b"));
  }
  const std::string file = journal_file(directory.path());
  const std::string whole = testing::contents(file);
  testing::write(file, whole.substr(0, whole.rfind("\n{") + 1));
  REQUIRE(read_journal(directory.path()).entries.answers.size() == 1);
  { Store::open_or_create(directory.path(), study); }
  CHECK(testing::contents(file) == whole);
}

TEST_CASE("the recorder saves from its own thread and hands failures back",
          "[results][recorder][threads]") {
  const testing::TempDirectory directory;
  auto [store, row] = begun_study(directory.path());
  core::SpscRing<core::TraceSample> ring{64};
  TraceCollector collector{ring};
  {
    Recorder recorder{store};
    recorder.follow(collector);
    for (int tick = 0; tick < 5000; ++tick) {  // far more than fits at once
      core::TraceSample sample{};
      sample.t_ns = tick;
      while (!ring.try_push(sample)) {
        std::this_thread::yield();
      }
    }
    recorder.leave();
    TrialRecord record = trial(row.id, 1, "a");
    auto collected = collector.finish();
    record.trace = std::move(collected.chunks);
    recorder.save(std::make_shared<const TrialRecord>(record)).get();
    CHECK_THROWS_AS(recorder.save(std::make_shared<const TrialRecord>(record)).get(), StoreError);
    recorder.save(std::make_shared<const TrialRecord>(trial(row.id, 2, "a")));  // not waited for
  }
  CHECK(store.answered_trials("P01") == std::vector<int>{1, 2});
  CHECK(store.trace(1).size() == 5000);
  CHECK(store.trace(1).back().t_ns == 4999);
}

TEST_CASE("SHA-256 agrees with sha256sum", "[results]") {
  const testing::TempDirectory directory;
  testing::write(directory / "text", "tapstudy\n");
  const auto result = testing::run_program({"/usr/bin/sha256sum", directory / "text"});
  CHECK_THAT(result.standard_output, Catch::Matchers::StartsWith(sha256("tapstudy\n")));
}

TEST_CASE("a form is stored whole, once, and again in the journal", "[results][store][forms]") {
  const testing::TempDirectory directory;
  {
    auto [store, row] = testing::small_study::begun_study(directory.path());
    const std::vector<FormAnswerRow> answers{
        {row.id, 1.0, "about", "session begin", "hand", "left"},
        {row.id, 1.0, "about", "session begin", "age", std::nullopt}};
    store.add_form(answers);
    CHECK_THROWS(store.add_form(answers));
    CHECK_THROWS(store.add_form({{row.id, 2.0, "load", "main", "effort", "0.5"}, answers.front()}));
    store.add_trial(testing::small_study::trial(row.id, 1, "a"));
    const std::vector<FormAnswerRow> of_participant = store.form_answers_of("P01");
    REQUIRE(of_participant.size() == 2);
    CHECK(of_participant[0].answer == "left");
    CHECK(of_participant[1].item == "age");
    CHECK(store.form_answers_of("P02").empty());
  }
  std::filesystem::remove(directory / "study.db");
  Store store = Store::from_journal(directory.path());
  const std::vector<FormAnswerRow> kept = store.entries_for_journal().form_answers;
  REQUIRE(kept.size() == 2);
  CHECK(kept[0].answer == "left");
  CHECK(kept[1].answer == std::nullopt);
}
