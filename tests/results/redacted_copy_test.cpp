// A copy of a study to be given away.
#include <filesystem>

#include "support/catch.hpp"
#include "support/messy_study.hpp"
using namespace tapstudy;
using testing::TempDirectory;
namespace fs = std::filesystem;
namespace messy = testing::messy_study;

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
