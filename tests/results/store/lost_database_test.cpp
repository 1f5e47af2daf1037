// A database that is lost, damaged or another's, beside a journal that holds answers.
#include <filesystem>
#include <functional>

#include "core/files/sha256.hpp"
#include "results/store/sqlite.hpp"
#include "results/store/study_queries.hpp"
#include "results/store_error.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/stored_study.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace tapstudy::results;
using namespace tapstudy::testing::small_study;
using testing::TempDirectory;

namespace {
struct Damage {
  const char* name;
  std::function<void(const std::string& database)> make;
};

const std::vector<Damage>& damages() {
  static const std::vector<Damage> all{
      {"missing", [](const std::string& file) { std::filesystem::remove(file); }},
      {"empty", [](const std::string& file) { testing::write(file, ""); }},
      {"a text", [](const std::string& file) { testing::write(file, std::string(5000, 'x')); }},
      {"zeros", [](const std::string& file) { testing::write(file, std::string(8192, '\0')); }},
      {"cut off", [](const std::string& file) { std::filesystem::resize_file(file, 10'000); }},
      {"overwritten",
       [](const std::string& file) {
         std::string text = testing::contents(file);
         text.replace(4096, 8192, std::string(8192, '\xA5'));
         testing::write(file, text);
       }},
      {"another program's",
       [](const std::string& file) {
         std::filesystem::remove(file);
         Database{file, Database::Access::write}.run("CREATE TABLE bookmarks (page)");
       }},
      {"without tables", [](const std::string& file) {
         std::filesystem::remove(file);
         Database{file, Database::Access::write}.run("CREATE TABLE t (x); DROP TABLE t");
       }}};
  return all;
}

void write_two_answers(const std::string& directory) {
  auto [store, row] = begun_study(directory);
  store.add_trial(trial(row.id, 1, "a"));
  store.add_trial(trial(row.id, 2, "b"));
}
}  // namespace

TEST_CASE("whoever opens a store whose database is lost is told how to read the journal's answers",
          "[results][store][journal]") {
  for (const Damage& damage : damages()) {
    CAPTURE(damage.name);
    const TempDirectory directory;
    write_two_answers(directory.path());
    const std::string journal = testing::contents(journal_file(directory.path()));
    damage.make(directory / "study.db");
    const std::string where = "answers.journal holds what was answered (2 answers to trials)";
    const std::string how = "`tapstudy report " + directory.path() + "` reads it";
    CHECK_THROWS_WITH(Store::open_existing(directory.path()), Contains(where) && Contains(how));
    CHECK_THROWS_WITH(Store::open_or_create(directory.path(), study),
                      Contains(where) && Contains(how));
    CHECK(testing::contents(journal_file(directory.path())) == journal);
    std::filesystem::remove(directory / "study.db");
    Store rebuilt = Store::from_journal(directory.path());
    CHECK(stored_answers(rebuilt).size() == 2);
  }
}

TEST_CASE("no command says of a journal with answers that there are none, or adds to it",
          "[results][store][journal]") {
  const TempDirectory directory;
  const std::string study = testing::messy_study::make(directory);
  const std::string protocol = testing::source("tests/data/every_screen.yaml");
  const std::string journal = testing::contents(journal_file(study));
  const std::string database = testing::contents(study + "/study.db");
  for (const Damage& damage : damages()) {
    testing::write(study + "/study.db", database);
    damage.make(study + "/study.db");
    std::vector<std::vector<std::string>> commands{
        {"verify", study},
        {"export", study, "--out", directory / "csv"},
        {"run", protocol, "--participant", "P09", "--out", study},
        {"simulate", protocol, "--participants", "1", "--out", study}};
    if (std::filesystem::exists(study + "/study.db")) {  // else it reads the journal
      commands.push_back({"report", study, "--replace"});
    }
    for (const auto& command : commands) {
      CAPTURE(damage.name, command[0]);
      const auto run = testing::tapstudy(command);
      CHECK(run.exit_code == 5);
      CHECK_THAT(run.standard_error, Contains("answers.journal holds what was answered"));
    }
    CHECK(testing::contents(journal_file(study)) == journal);
    std::filesystem::remove(study + "/study.db");
    CHECK(testing::tapstudy({"report", study, "--mode", "simulated", "--replace"}).exit_code == 0);
  }
}

TEST_CASE("a database that is not the journal's adds nothing to it", "[results][store][journal]") {
  const TempDirectory directory;
  write_two_answers(directory.path());
  const std::string earlier = testing::contents(directory / "study.db");
  SECTION("an earlier copy") {
    SessionRow second = session("P02");
    second.participant_index = 1;
    Store::open_or_create(directory.path(), study).add_session(second);
    testing::write(directory / "study.db", earlier);
    const std::string journal = testing::contents(journal_file(directory.path()));
    CHECK_THROWS_WITH(Store::open_or_create(directory.path(), study),
                      Contains("session 2 of participant 'P02', which this one lacks"));
    CHECK(testing::contents(journal_file(directory.path())) == journal);
  }
  SECTION("of the same protocol, begun at another time") {
    const TempDirectory other;
    {
      Store store = Store::open_or_create(other.path(), study);
      SessionRow row = session("P01");
      row.started_utc = "2026-02-02T00:00:00Z";
      store.add_session(row);
    }
    testing::write(directory / "study.db", testing::contents(other / "study.db"));
    CHECK_THROWS_WITH(Store::open_or_create(directory.path(), study),
                      Contains("is of another study than"));
  }
  SECTION("of another protocol") {
    const TempDirectory other;
    StudyRow another = study;
    another.protocol_text += "\n";
    another.protocol_sha256 = core::sha256(another.protocol_text);
    { Store::open_or_create(other.path(), another); }
    testing::write(directory / "study.db", testing::contents(other / "study.db"));
    CHECK_THROWS_WITH(Store::open_or_create(directory.path(), another),
                      Contains("answered under another protocol"));
  }
}

TEST_CASE("a journal without a whole line takes nobody's place: the study is begun anew",
          "[results][store][journal]") {
  const TempDirectory directory;
  testing::write(directory / "study.db", "");
  testing::write(journal_file(directory.path()), "{\"kind\":\"stu");
  CHECK_FALSE(Store::is_begun(directory.path()));
  write_two_answers(directory.path());
  CHECK(Store::is_begun(directory.path()));
  CHECK(read_journal(directory.path()).entries.answers.size() == 2);
}

TEST_CASE("run goes on with the unfinished beginning of a study", "[results][store]") {
  const TempDirectory directory;
  testing::write(directory / "study.db", "");
  const auto run = testing::tapstudy({"run", testing::source("tests/data/every_screen.yaml"),
                                      "--participant", "P01", "--out", directory.path()});
  CHECK_THAT(run.standard_error, !Contains("unfinished beginning"));
  CHECK(Store::open_existing(directory.path()).sessions().size() == 1);
}
