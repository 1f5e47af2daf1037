// What a session does when its context fail: nothing that was confirmed is lost.
#include <fmt/format.h>

#include <filesystem>

#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using testing::TempDirectory;

namespace {
// A shell script in which `tapstudy` (`$tapstudy` to be the process $!), `$study` (a protocol) and
// `$out` have a meaning.
testing::ProgramResult shell(const TempDirectory& directory, const std::string& script) {
  return testing::run_program(
      {"/bin/bash", "-c",
       fmt::format(
           "tapstudy={}; tapstudy() {{ $tapstudy \"$@\"; }}; study={}; out={}/the_study; cd {}\n{}",
           testing::tapstudy_program(), testing::shipped("paper/discrimination.yaml").string(),
           directory.path(), directory.path(), script)});
}
std::string sql(const TempDirectory& directory, const std::string& query) {
  return testing::run_program({"/usr/bin/sqlite3", directory / "the_study/study.db", query})
      .standard_output;
}
constexpr const char* every_trial =
    "SELECT group_concat(number || status) FROM (SELECT number, status FROM trial ORDER BY "
    "trial_id)";
}  // namespace

TEST_CASE("a directory named like a URI is a directory", "[end_to_end][store]") {
  const TempDirectory directory;
  const auto result = shell(
      directory, "tapstudy simulate $study --participants 1 --seed 1 --out 'file:s?mode=memory'");
  INFO(result.standard_error);
  CHECK(result.exit_code == 0);
  CHECK_FALSE(testing::contents(directory / "file:s?mode=memory/study.db").empty());
}

TEST_CASE("sessions of new participants begun at once all get an index of their own",
          "[end_to_end][store][slow]") {
  const TempDirectory directory;
  const auto result = shell(
      directory,
      "tapstudy simulate $study --participants 1 --seed 1 --out $out >/dev/null 2>&1\n"
      "for i in 1 2 3 4; do (printf '1\\n' | tapstudy run $study --participant P0$i --out $out "
      "2>said_$i; echo $?) & done; wait");
  CHECK(result.standard_output == "130\n130\n130\n130\n");  // the input ends after one answer
  CHECK(sql(directory,
            "SELECT count(DISTINCT participant_index), count(*) FROM participant WHERE mode <> "
            "'simulated'") == "4|4\n");
}

TEST_CASE("a link to a study is the same study to a participant", "[end_to_end][store]") {
  const TempDirectory directory;
  const auto result = shell(directory,
                            "mkdir $out; ln -s $out link\n"
                            "(sleep 4; echo quit) | tapstudy run $study --participant P01 --out "
                            "$out 2>/dev/null & sleep 2\n"
                            "echo 1 | tapstudy run $study --participant P01 --out link; wait");
  CHECK_THAT(result.standard_error, Contains("is in a session of this study right now"));
}

TEST_CASE("a session without an input ends at once, and stores no answer", "[end_to_end][store]") {
  const TempDirectory directory;
  const auto result =
      shell(directory, "tapstudy run $study --participant P01 --out $out <&- 2>said; echo $?");
  CHECK(result.standard_output == "130\n");
  CHECK(sql(directory, every_trial) == "1interrupted\n");
}

TEST_CASE("a terminal whose reader has gone stops the session, and the open trial is stored",
          "[end_to_end][store]") {
  const TempDirectory directory;
  const auto result = shell(
      directory,
      "mkfifo ears; (head -c 100 ears >/dev/null) &\n"
      "(for i in 1 2 3 4 5 6 7 8; do echo 1; sleep 1; done) | tapstudy run $study --participant "
      "P01 --out $out 2>ears; echo ${PIPESTATUS[1]}");
  CHECK(result.standard_output == "130\n");
  CHECK_THAT(sql(directory, every_trial), Contains("interrupted") && !Contains("8"));
  CHECK(sql(directory, "PRAGMA integrity_check") == "ok\n");
}

TEST_CASE("a file that may grow no further is one error, and loses no answer",
          "[end_to_end][store]") {
  const TempDirectory directory;
  const auto result = shell(
      directory,
      "tapstudy simulate $study --participants 1 --seed 1 --out $out >/dev/null 2>&1; ulimit -f "
      "90\n"
      "(for i in 1 2 3 4 5 6 7 8; do echo 1; sleep 0.3; done) | tapstudy run $study --participant "
      "P01 --out $out; echo ${PIPESTATUS[1]}");
  CHECK(result.standard_output == "5\n");
  CHECK_THAT(result.standard_error, Contains("is the disk full?") && Contains("not stored yet"));
  CHECK(sql(directory, "PRAGMA integrity_check") == "ok\n");
}

TEST_CASE(
    "what could not be stored is given up by nothing but quit, and stored once there is space",
    "[end_to_end][store]") {
  const TempDirectory directory;
  const std::string begin =
      "tapstudy simulate $study --participants 1 --seed 1 --out $out >/dev/null 2>&1\n"
      "mkfifo keys; exec 3<>keys; $tapstudy run $study --participant P01 --out $out <keys 2>said "
      "&\n"
      "until grep -q 'Trial 1' said 2>/dev/null; do sleep 0.1; done\n"
      "prlimit --pid $! --fsize=90000:unlimited\n"
      "while ! grep -q 'not stored yet' said && kill -0 $! 2>/dev/null; do echo 1 >&3; sleep 0.3; "
      "done\n"
      "for key in q no 1; do sleep 0.3; echo $key >&3; done; sleep 0.5; kill -0 $! || exit 9\n";
  SECTION("there is space again") {
    const auto result = shell(directory, begin +
                                             "prlimit --pid $! --fsize=unlimited:unlimited\n"
                                             "echo >&3; sleep 1; echo quit >&3; wait $!\n");
    INFO(result.standard_error);
    CHECK(result.exit_code == 130);
    const std::string stored = sql(directory, every_trial);
    const std::string said = testing::contents(directory / "said");
    CHECK_THAT(said.substr(said.find("not stored yet")), Contains("saved,"));
    CHECK(sql(directory, "PRAGMA integrity_check") == "ok\n");
    CHECK(shell(directory, "tapstudy verify $out").exit_code == 0);
  }
  SECTION("it is given up") {
    const auto result = shell(directory, begin + "echo quit >&3; wait $!\n");
    CHECK(result.exit_code == 5);
  }
}

TEST_CASE("a presentation that was killed is recorded, and the next one is the second attempt",
          "[end_to_end][store]") {
  const TempDirectory directory;
  const auto result = shell(
      directory,
      "mkfifo keys; exec 3<>keys; $tapstudy run $study --participant P01 --out $out <keys 2>said "
      "&\n"
      "until grep -q 'Trial 1' said 2>/dev/null; do sleep 0.1; done; sleep 1; kill -KILL $!; wait\n"
      "(sleep 1; echo 1; sleep 1) | tapstudy run $study --participant P01 --out $out --resume");
  INFO(result.standard_error);
  CHECK(sql(directory,
            "SELECT session_id, count(*) FROM session_event WHERE state = 'exploring' AND "
            "number = 1 GROUP BY session_id") == "1|1\n2|1\n");
  CHECK(sql(directory, "SELECT attempt FROM trial WHERE number = 1 AND status = 'answered'") ==
        "2\n");
}

TEST_CASE("verify compares what is stored twice, and a report is made from either",
          "[end_to_end][store]") {
  const TempDirectory directory;
  const auto result = shell(
      directory,
      "tapstudy simulate $study --participants 2 --seed 1 --out $out >/dev/null 2>&1\n"
      "tapstudy verify $out && cp -r $out other && rm other/study.db\n"
      "tapstudy report $out --out one >/dev/null && tapstudy report other --out two >/dev/null && "
      "rm */*_exploration.csv */loop_quality.csv */rendered_*.csv && diff <(cat one/*.csv) <(cat "
      "two/*.csv) && echo same");  // taps and ticks are in the database alone
  INFO(result.standard_error);
  CHECK_THAT(result.standard_output,
             Contains("their answers and actions agree") && Contains("same\n"));
  CHECK_THAT(result.standard_error, Contains("made from answers.journal alone"));
  sql(directory, "UPDATE response SET response = 'mdf_two' WHERE response_id = 3");
  const auto changed = shell(directory, "tapstudy verify $out; echo $?");
  CHECK_THAT(changed.standard_output,
             Contains("not in study.db: {\"kind\":\"answer\"") && Contains("5\n"));
}

TEST_CASE("without gnuplot a figure is one error, and no empty file is left", "[end_to_end]") {
  const TempDirectory directory;
  const auto result = shell(directory,
                            "PATH=/nowhere tapstudy modes $study --stimulus mdf_two --figure "
                            "modes.svg; echo $?");
  CHECK(result.standard_output == "2\n");
  CHECK_THAT(result.standard_error, Contains("figures need gnuplot"));
  CHECK_FALSE(std::filesystem::exists(directory / "modes.svg"));
}

TEST_CASE("a report that cannot be written leaves nothing behind, and the next one succeeds",
          "[end_to_end]") {
  const TempDirectory directory;
  const auto result =
      shell(directory,
            "tapstudy simulate $study --participants 2 --seed 1 --out $out >/dev/null 2>&1\n"
            "(ulimit -f 8; tapstudy report $out --out reports >/dev/null; echo $?); ls reports\n"
            "tapstudy report $out --out reports >/dev/null; echo $?; ls reports");
  CHECK_THAT(result.standard_output,
             Catch::Matchers::StartsWith("2\n0\n") && Contains("report.html\nreport.json\n"));
}

TEST_CASE("a report of a study names the sessions that ended early", "[end_to_end]") {
  const TempDirectory directory;
  const auto result = shell(directory,
                            "printf '1\\n2\\n' | tapstudy run $study --participant P01 --out $out "
                            "2>/dev/null; tapstudy report $out");
  CHECK_THAT(result.standard_output, Contains("unfinished: P01: 2 of 8 trials"));
}
