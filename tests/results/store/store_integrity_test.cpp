// A store that is killed, or whose writes fail: what was confirmed is there.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "core/random/rng.hpp"
#include "results/store/recorder.hpp"
#include "results/store_error.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/stored_study.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace tapstudy::results;
using namespace tapstudy::testing::small_study;

namespace {
// Stores trials from the first that is open on, and tells the number of each once it is confirmed.
[[noreturn]] void store_without_end(const std::string& directory, int to_parent) {
  auto store = Store::open_or_create(directory, study);
  SessionRow row = session("P01");
  store.add_session(row);
  for (int number = 1 + static_cast<int>(store.answered_trials("P01").size());; ++number) {
    store.add_trial(trial(row.id, number, "a"));
    if (write(to_parent, &number, sizeof number) != sizeof number) {
      _exit(1);
    }
  }
}

// The last trial confirmed before the kill, which comes some time after so many were; 0 if none.
int confirmed_before_kill(const std::string& directory, std::size_t trials,
                          std::chrono::microseconds after) {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    store_without_end(directory, ends[1]);
  }
  close(ends[1]);
  int confirmed = 0;
  for (std::size_t i = 0; i < trials; ++i) {
    REQUIRE(read(ends[0], &confirmed, sizeof confirmed) == sizeof confirmed);
  }
  std::this_thread::sleep_for(after);
  kill(child, SIGKILL);
  for (int number = 0; read(ends[0], &number, sizeof number) == sizeof number;) {
    confirmed = number;
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  REQUIRE(WIFSIGNALED(status));
  return confirmed;
}

bool agrees_with_journal(const std::string& directory) {
  return testing::tapstudy({"verify", directory}).exit_code == 0;
}
}  // namespace

TEST_CASE("of a hundred kills at random moments none loses or doubles a confirmed answer",
          "[results][store][slow]") {
  const testing::TempDirectory directory;
  core::Rng rng{20};
  int confirmed = 0;
  for (int i = 0; i < 100; ++i) {
    const auto trials = static_cast<std::size_t>(3.0 * rng.uniform());  // 0: while it begins
    const std::chrono::microseconds after{static_cast<int>(30e3 * rng.uniform())};
    confirmed = std::max(confirmed, confirmed_before_kill(directory.path(), trials, after));
    if (!Store::has_database(directory.path())) {
      continue;  // killed before there was a study
    }
    const auto done = Store::open_or_create(directory.path(), study).answered_trials("P01");
    CAPTURE(i, confirmed, done.size());
    REQUIRE(static_cast<int>(done.size()) >= confirmed);
    for (std::size_t k = 0; k < done.size(); ++k) {
      REQUIRE(done[k] == static_cast<int>(k) + 1);
    }
  }
  CHECK(confirmed > 10);  // or nothing was tried
  CHECK(agrees_with_journal(directory.path()));
}

// SIGXFSZ is ignored by the program: a write beyond the limit fails with EFBIG, as on a full disk.
TEST_CASE("of fifty write errors at different places none loses or doubles a confirmed answer",
          "[results][store][slow]") {
  const auto usual_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit usual{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &usual) == 0);
  int failures = 0;
  for (rlim_t limit = 60'000; limit < 60'000 + 50 * 1'237; limit += 1'237) {
    const testing::TempDirectory directory;
    CAPTURE(limit);
    std::vector<int> confirmed;
    {
      auto [store, row] = begun_study(directory.path());
      const rlimit lowered{limit, usual.rlim_max};
      setrlimit(RLIMIT_FSIZE, &lowered);
      int number = 1;
      try {
        for (; number <= 40; ++number) {
          store.add_trial(trial(row.id, number, "a"));
          confirmed.push_back(number);
        }
      } catch (const StoreError&) {
        ++failures;
      }
      setrlimit(RLIMIT_FSIZE, &usual);
      for (; number <= 40; ++number) {  // space again: the same record is taken
        store.add_trial(trial(row.id, number, "a"));
        confirmed.push_back(number);
      }
    }
    CHECK(Store::open_existing(directory.path()).answered_trials("P01") == confirmed);
    CHECK(agrees_with_journal(directory.path()));
  }
  std::signal(SIGXFSZ, usual_handler);
  CHECK(failures >= 40);
}

TEST_CASE("changes of state that a full disk refused are stored once, before the next trial",
          "[results][recorder][store]") {
  const testing::TempDirectory directory;
  auto [store, row] = begun_study(directory.path());
  const auto usual_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit usual{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &usual) == 0);
  Recorder recorder{store};
  const rlimit full{1, usual.rlim_max};
  setrlimit(RLIMIT_FSIZE, &full);
  CHECK_THROWS_AS(recorder.note({{row.id, 1.0, "exploring", 1, ""}}).get(), StoreError);
  const auto first = std::make_shared<const TrialRecord>(trial(row.id, 1, "a"));
  CHECK_THROWS_AS(recorder.save(first).get(), StoreError);
  setrlimit(RLIMIT_FSIZE, &usual);
  std::signal(SIGXFSZ, usual_handler);
  recorder.save(first).get();
  recorder.note({{row.id, 2.0, "answering", 1, ""}}).get();
  Database stored{directory.path() + "/study.db", Database::Access::read};
  Statement states{stored, "SELECT group_concat(state, ' ') FROM session_event"};
  REQUIRE(states.step());
  CHECK(states.text(0) == "exploring answering");
}

TEST_CASE("a file that a dead program left half changed is read as it was before the change",
          "[results][store]") {
  const testing::TempDirectory directory;
  {
    auto [store, row] = begun_study(directory.path());
    store.add_trial(trial(row.id, 1, "a"));
  }
  const std::string file = directory.path() + "/study.db";
  const pid_t child = fork();
  if (child == 0) {
    Database database{file, Database::Access::write};
    database.run(
        "PRAGMA cache_size = 1; BEGIN; CREATE TABLE t(x); WITH RECURSIVE n(i) AS "
        "(SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 100) "
        "INSERT INTO t SELECT randomblob(10000) FROM n");
    raise(SIGKILL);
  }
  waitpid(child, nullptr, 0);
  REQUIRE(std::filesystem::exists(file + "-journal"));
  CHECK(Store::open_existing(directory.path()).answered_trials("P01") == std::vector<int>{1});
  CHECK(agrees_with_journal(directory.path()));
}

// What a study stores twice: one is recomputed from the other.
using testing::TempDirectory;
namespace messy = testing::messy_study;

namespace {
void change(const std::string& study, const std::string& statement) {
  const auto run = testing::run_program({"/usr/bin/sqlite3", study + "/study.db", statement + ";"});
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
}
// Changes one value, verifies, changes it back.
std::string said_of(const std::string& study, const std::string& column, const std::string& to,
                    const std::string& back, const std::string& where) {
  const std::string table = column.substr(0, column.find('.'));
  const std::string name = column.substr(column.find('.') + 1);
  const auto set = [&](const std::string& value) {
    change(study, "UPDATE " + table + " SET " + name + " = " + value + " WHERE " + where);
  };
  set(to);
  const auto run = testing::tapstudy({"verify", study});
  set(back);
  CHECK(run.exit_code == 5);
  CHECK_THAT(run.standard_error, Contains("those recomputed: 1\n") || Contains("recomputed: 1;"));
  return run.standard_output;
}
}  // namespace

TEST_CASE("verify names the one value that was changed", "[results][verify]") {
  const TempDirectory directory;
  const std::string study = messy::make(directory);
  const auto untouched = testing::tapstudy({"verify", study});
  INFO(untouched.standard_output << untouched.standard_error);
  REQUIRE(untouched.exit_code == 0);
  CHECK_THAT(untouched.standard_output, Contains("answers by their task's rule\n"));

  const std::string first = "response_id = 1";
  CHECK_THAT(said_of(study, "response.is_correct", "1 - is_correct", "1 - is_correct", first),
             Contains("number 1): response 1: is_correct"));
  CHECK_THAT(said_of(study, "response.time_from_first_contact_s", "time_from_first_contact_s * 2",
                     "time_from_first_contact_s / 2", first),
             Contains("response 1: time_from_first_contact_s"));
  CHECK_THAT(said_of(study, "event.value", "value * 2", "value / 2",
                     "rowid = (SELECT min(rowid) FROM event WHERE kind = 'impact')"),
             Contains("event is impact"));
  CHECK_THAT(said_of(study, "tick_statistics.ticks", "ticks + 1", "ticks - 1", "trial_id = 2"),
             Contains("): tick_statistics.ticks"));
  CHECK_THAT(said_of(study, "trial.duration_s", "duration_s + 1", "duration_s - 1",
                     "trial_id = (SELECT max(trial_id) FROM trial)"),
             Contains("trial.duration_s is 3, recomputed 2"));
  const std::string later = " WHERE trial_id = (SELECT max(trial_id) FROM trial) AND position > 0";
  change(study, "UPDATE alternative SET position = position + 1" + later);
  CHECK_THAT(testing::tapstudy({"verify", study}).standard_output,
             Contains("alternative.position is 2, recomputed 1"));
  change(study, "UPDATE alternative SET position = position - 1" + later);
  CHECK_THAT(said_of(study, "trace_chunk.first_tick", "first_tick + 1", "first_tick - 1",
                     "trial_id = (SELECT min(trial_id) FROM trace_chunk) AND first_tick < 2"),
             Contains("trace_chunk.first_tick is 1, recomputed 0"));
  const std::string corrected =
      "response_id = (SELECT max(response_id) FROM response WHERE supersedes IS NOT NULL)";
  CHECK_THAT(said_of(study, "response.supersedes", "supersedes + 1", "supersedes - 1", corrected),
             Contains(": supersedes is "));
  CHECK_THAT(said_of(study, "response.confidence", "3", "NULL", corrected),
             Contains(": confidence is 3, recomputed NULL"));
  CHECK(testing::tapstudy({"verify", study}).exit_code == 0);
  change(study, "DELETE FROM tick_statistics WHERE trial_id = (SELECT max(trial_id) FROM trial)");
  const auto lacking = testing::tapstudy({"verify", study});
  CHECK(lacking.exit_code == 5);
  CHECK_THAT(lacking.standard_output, Contains("tick_statistics is missing"));
}

TEST_CASE("a protocol that cannot be read leaves the traces to be verified", "[results][verify]") {
  const TempDirectory directory;
  {
    auto [store, row] = testing::small_study::begun_study(directory.path());
    store.add_trial(testing::small_study::trial(row.id, 1, "a"));
  }
  const auto run = testing::tapstudy({"verify", directory.path()});
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.standard_output, Contains("1 of blocks that the protocol lacks"));
  CHECK_THAT(run.standard_error, Contains("protocol cannot be read"));
}

// A copy of a study to be given away.
namespace fs = std::filesystem;

namespace {
std::string sql(const std::string& study, const std::string& query) {
  return testing::run_program({"/usr/bin/sqlite3", study + "/study.db", query}).standard_output;
}
bool is_in_a_file(const std::string& text, const std::string& directory) {
  return testing::run_program({"/bin/grep", "-rqaF", text, directory}).exit_code == 0;
}
std::string redacted(const TempDirectory& directory, const std::string& study) {
  const auto run = testing::tapstudy({"redact", study, "--out", directory / "copy"});
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  return directory / "copy";
}
}  // namespace

TEST_CASE("no byte of a redacted copy holds a name, a note or free text", "[results][redact]") {
  const TempDirectory directory;
  const std::string study = messy::make(directory);
  {  // also what was replaced earlier, and what only the log holds
    const results::StudyRow row = results::Store::open_existing(study).study();
    auto store = results::Store::open_or_create(study, row);
    store.add_session_events({{3, 20.0, "stopped", {}, "fire alarm"}});
  }
  const std::string copy = redacted(directory, study);
  for (const char* const removed : {"Anna", "P02", "sim-0", "say ", "early", "by mistake",
                                    "fire alarm", "=cmd()|", "/tests/data/"}) {
    CAPTURE(removed);
    CHECK(is_in_a_file(removed, study));
    CHECK(is_in_a_file(removed, copy) ==
          (std::string{removed} == "=cmd()|"));  // an answer to a trial
  }
  CHECK(sql(copy, "SELECT count(*) FROM form_answer WHERE answer = '(removed)'") == "1\n");
  CHECK(fs::exists(copy + "/answers.journal"));
  CHECK(testing::entries(copy) == 2);
}

TEST_CASE("a redacted copy verifies, reports and exports as the study does", "[results][redact]") {
  const TempDirectory directory;
  const std::string study = messy::make(directory);
  const std::string copy = redacted(directory, study);
  const auto verified = testing::tapstudy({"verify", copy});
  INFO(verified.standard_error);
  CHECK(verified.exit_code == 0);
  CHECK(verified.standard_output == testing::tapstudy({"verify", study}).standard_output);
  for (const char* const table :
       {"trial", "response", "event", "trace_chunk", "alternative", "axis_value"}) {
    const std::string all = std::string{"SELECT * FROM "} + table + " ORDER BY 1, 2, 3";
    CHECK(sql(copy, all) == sql(study, all));
  }
  CHECK(sql(copy, "SELECT participant_id, mode, is_excluded FROM v_sessions") ==
        "person-001|simulated|0\nperson-002|simulated|0\nperson-003|real|0\n"
        "person-004|pilot|1\nperson-005|pilot|0\n");
  CHECK(testing::tapstudy({"report", copy, "--mode", "simulated"}).exit_code == 0);
  CHECK(testing::tapstudy({"export", copy, "--out", directory / "csv"}).exit_code == 0);
}

TEST_CASE("a redacted copy replaces nothing and comes from a study", "[results][redact]") {
  const TempDirectory directory;
  const std::string study = messy::make(directory);
  CHECK_THAT(testing::tapstudy({"redact", study, "--out", study}).standard_error,
             Contains("exists already"));
  const auto run = testing::tapstudy({"redact", directory / "none", "--out", directory / "copy"});
  CHECK(run.exit_code == 2);
  CHECK_THAT(run.standard_error, Contains("there is no study here"));
  CHECK_FALSE(fs::exists(directory / "copy"));
}
