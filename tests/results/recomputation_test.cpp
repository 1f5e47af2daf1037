// What a study stores twice: one is recomputed from the other.
#include "support/catch.hpp"
#include "support/messy_study.hpp"
using namespace tapstudy;
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
