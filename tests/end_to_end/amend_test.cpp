// What an operator says of a session after it.
#include <algorithm>

#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using testing::TempDirectory;

namespace {
std::string sql(const TempDirectory& directory, const std::string& query) {
  return testing::run_program({"/usr/bin/sqlite3", (directory / "study") + "/study.db", query})
      .standard_output;
}

testing::ProgramResult amend(const TempDirectory& directory, const std::string& participant,
                             const std::string& action) {
  return testing::tapstudy({"amend", directory / "study", action, "--participant", participant});
}

void simulate(const TempDirectory& directory, const std::string& protocol) {
  REQUIRE(testing::tapstudy({"simulate", protocol, "--participants", "2", "--seed", "3", "--out",
                             directory / "study"})
              .exit_code == 0);
}
}  // namespace

TEST_CASE("after a session any answer is corrected, remarks and exclusions are added, and verified",
          "[end_to_end]") {
  const TempDirectory directory;
  simulate(directory, testing::shipped("paper/discrimination.yaml").string());
  const auto corrected = amend(directory, "sim-02", "correct @3 2");
  INFO(corrected.standard_error);
  CHECK(corrected.exit_code == 0);
  CHECK_THAT(corrected.standard_output,
             Contains("participant sim-02, block 'discrimination': correct, "
                      "trial 3"));
  CHECK(amend(directory, "sim-01", "note @5 coughed").exit_code == 0);
  CHECK(amend(directory, "sim-01", "exclude numb fingers").exit_code == 0);
  CHECK(sql(directory,
            "SELECT participant_id, number, response, given_by FROM current_response "
            "JOIN trial USING (trial_id) JOIN session USING (session_id) "
            "WHERE supersedes IS NOT NULL") == "sim-02|3|mdf_two|operator\n");
  CHECK(sql(directory,
            "SELECT is_correct = (response = stimulus) FROM v_trials "
            "WHERE is_corrected") == "1\n");
  CHECK(sql(directory,
            "SELECT participant_id, action, number, detail, t_s >= 0 FROM operator_action "
            "JOIN session USING (session_id)") ==
        "sim-02|correct|3|mdf_two|1\nsim-01|note|5|coughed|1\nsim-01|exclude||numb fingers|1\n");
  CHECK(testing::tapstudy({"verify", directory / "study"}).exit_code == 0);
  const auto report = testing::tapstudy({"report", directory / "study"});
  CHECK_THAT(report.standard_output, Contains("numb fingers"));
  CHECK(amend(directory, "sim-01", "include").exit_code == 0);
  CHECK(sql(directory, "SELECT count(*) FROM excluded_participant") == "0\n");
  CHECK(amend(directory, "sim-02", "exclude sleepy").exit_code == 0);
  const auto verified = testing::tapstudy({"verify", directory / "study"});
  CHECK(verified.exit_code == 0);
  CHECK_THAT(verified.standard_output, Contains("older than the last entry"));
}

TEST_CASE("an answer that names a blind label is corrected to what had that label in its trial",
          "[end_to_end]") {
  const TempDirectory directory;
  simulate(directory, testing::shipped("paper/reality_finger.yaml").string());
  const std::string b = sql(directory,
                            "SELECT stimulus FROM alternative JOIN trial USING (trial_id) "
                            "JOIN session USING (session_id) WHERE participant_id = 'sim-02' "
                            "AND number = 1 AND label = 'B'");
  REQUIRE(amend(directory, "sim-02", "correct @1 2").exit_code == 0);
  CHECK(sql(directory, "SELECT response FROM current_response WHERE supersedes IS NOT NULL") == b);
}

TEST_CASE("what cannot be amended is refused in one line, and nothing is stored", "[end_to_end]") {
  const TempDirectory directory;
  simulate(directory, testing::shipped("paper/discrimination.yaml").string());
  const auto check_refused = [&](const std::string& participant, const std::string& action,
                                 const std::string& why) {
    CAPTURE(action);
    const auto refused = amend(directory, participant, action);
    CHECK(refused.exit_code == 2);
    CHECK_THAT(refused.standard_error, Contains(why));
    CHECK(std::ranges::count(refused.standard_error, '\n') == 1);
  };
  check_refused("sim-01", "pause", "concerns a running session");
  check_refused("sim-01", "correct 2", "which trial?");
  check_refused("sim-01", "correct @99 2", "trial 99 was not presented");
  check_refused("sim-01", "exclude @3 asleep", "concerns the participant, not a trial");
  check_refused("sim-01", "note \xff\xfe", "must be UTF-8 text");
  check_refused("sim-01", "note \033[31mred", "must be UTF-8 text");
  check_refused("sim-01", "correct @3 9", "'9' is not a number from 1 to 4");
  check_refused("sim-01", "include", "include is not possible now");
  check_refused("sim-01", "exclude", "REASON");
  check_refused("nobody", "note hello", "there is no 'nobody'");
  check_refused("sim-01", "sing", "is not a command (one of: correct, note, exclude, include)");
  CHECK(sql(directory, "SELECT count(*) FROM operator_action") == "0\n");
  CHECK(testing::tapstudy({"amend", directory / "nothing", "note x", "--participant", "a"})
            .exit_code == 2);
}

TEST_CASE("a study is one however its directory is written, from before it is there",
          "[end_to_end][threads]") {
  const TempDirectory directory;
  const auto run = testing::run_program(
      {"/bin/sh", "-c",
       "cd \"$1\" && mkfifo keys && touch log || exit 1\n"
       "\"$0\" run \"$2\" --participant P01 --out study <keys >log 2>&1 &\n"
       "exec 3>keys\n"
       "for i in $(seq 400); do grep -q 'Trial 1' log && break; sleep 0.05; done\n"
       "\"$0\" amend \"$1/study\" 'note now' --participant P01; echo $?\n"
       "exec 3>&-; wait",
       testing::tapstudy_program(), directory.path(),
       testing::shipped("paper/discrimination.yaml").string()});
  CHECK_THAT(run.standard_error, Contains("is in a session of this study right now"));
  CHECK_THAT(run.standard_output, Contains("2"));
}
