// A store that is killed, or whose writes fail: what was confirmed is there.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "core/rng.hpp"
#include "results/recorder.hpp"
#include "results/store_error.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/small_study.hpp"
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

// The last trial confirmed before the kill; 0 if none.
int confirmed_before_kill(const std::string& directory, std::chrono::microseconds after) {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    store_without_end(directory, ends[1]);
  }
  close(ends[1]);
  std::this_thread::sleep_for(after);
  kill(child, SIGKILL);
  int confirmed = 0;
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
    const std::chrono::microseconds after{static_cast<int>(60e3 * rng.uniform())};
    confirmed = std::max(confirmed, confirmed_before_kill(directory.path(), after));
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
