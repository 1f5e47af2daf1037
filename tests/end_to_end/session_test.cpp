// A person's session at the terminal, in real time with a simulated hand.
#include <fmt/format.h>

#include <filesystem>

#include "support/blocks.hpp"
#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/example_bridge.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using testing::TempDirectory;

namespace {
std::string paper(const std::string& name) {
  return testing::shipped("paper/" + name).string();
}
testing::ProgramResult session(const TempDirectory& directory, const std::string& protocol,
                               const std::string& input,
                               const std::vector<std::string>& more = {}) {
  std::vector<std::string> line{"run",   paper(protocol),         "--participant", "P01",
                                "--out", directory / "the_study", "--seed",        "5"};
  line.insert(line.end(), more.begin(), more.end());
  return testing::tapstudy(line, input);
}
std::string sql(const TempDirectory& directory, const std::string& query) {
  return testing::run_program({"/usr/bin/sqlite3", (directory / "the_study") + "/study.db", query})
      .standard_output;
}
}  // namespace

TEST_CASE("a session asks every question and stores every answer", "[end_to_end][threads]") {
  const TempDirectory directory;
  const auto result = session(directory, "discrimination.yaml", "1\n2\n9\nx\n3\n4\n1\n2\n3\n4\n");
  INFO(result.standard_error);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.standard_error, Contains("Trial 8 of 8"));
  CHECK_THAT(result.standard_error, Contains("please type a number from 1 to 4"));
  CHECK_THAT(result.standard_output, Contains("all 8 trials are stored"));
  CHECK(
      sql(directory, "SELECT group_concat(response) FROM response") ==
      "acrylic_two,mdf_two,acrylic_three,mdf_three,acrylic_two,mdf_two,acrylic_three,mdf_three\n");
  CHECK_THAT(sql(directory,
                 "SELECT mode, seed, device, scheduler FROM session "
                 "JOIN participant USING (participant_id)"),
             Catch::Matchers::StartsWith("pilot|5|simulated_hand|SCHED_"));
  CHECK(sql(directory,
            "SELECT doctor ->> '$.idle.count' BETWEEN 490 AND 510, length(doctor ->> '$.verdict') "
            "> 20 FROM session") == "1|1\n");
  CHECK(sql(directory, "SELECT sum(dropped_samples) FROM tick_statistics") == "0\n");
  CHECK(sql(directory, "PRAGMA integrity_check") == "ok\n");
}

TEST_CASE("a stopped session keeps its answers and is resumed at the next trial",
          "[end_to_end][threads]") {
  const TempDirectory directory;
  const auto stopped = session(directory, "discrimination.yaml", "1\n2\n3\n");
  CHECK(stopped.exit_code == 130);
  CHECK_THAT(stopped.standard_error, Contains("every answer given so far is kept"));
  CHECK(sql(directory, "SELECT group_concat(number || status) FROM trial") ==
        "1answered,2answered,3answered,4interrupted\n");
  CHECK(session(directory, "discrimination.yaml", "1\n").exit_code == 2);  // not without --resume
  const auto reseeded =
      testing::tapstudy({"run", paper("discrimination.yaml"), "--participant", "P01", "--out",
                         directory / "the_study", "--resume", "--seed", "123456"});
  CHECK(reseeded.exit_code == 2);
  CHECK_THAT(reseeded.standard_error, Contains("--seed"));
  const auto resumed = session(directory, "discrimination.yaml", "4\n4\n4\n4\n4\n", {"--resume"});
  INFO(resumed.standard_error);
  CHECK(resumed.exit_code == 0);
  CHECK_THAT(resumed.standard_error,
             Contains("participant P01 goes on with the session begun 20") &&
                 Contains("3 of 8 trials are done, 5 left"));
  CHECK(sql(directory,
            "SELECT count(DISTINCT number), count(*) FROM trial "
            "WHERE status = 'answered'") == "8|8\n");
  CHECK(sql(directory, "SELECT count(DISTINCT planned_order) FROM session") == "1\n");
  CHECK(sql(directory, "SELECT group_concat(attempt || status) FROM trial WHERE number = 4") ==
        "1interrupted,2answered\n");
}

TEST_CASE("participants whose ids differ in capital letters alone are one mistyped",
          "[end_to_end]") {
  const TempDirectory directory;
  session(directory, "reality_finger.yaml", "a\n");
  const auto as_p01 = [&](const std::vector<std::string>& more) {
    std::vector<std::string> line{"run",   paper("reality_finger.yaml"), "--participant", "p01",
                                  "--out", directory / "the_study"};
    line.insert(line.end(), more.begin(), more.end());
    return testing::tapstudy(line, "a\n");
  };
  const auto begun = as_p01({});
  CHECK(begun.exit_code == 2);
  CHECK_THAT(begun.standard_error, Contains("this study has a 'P01'"));
  const auto resumed = as_p01({"--resume"});
  CHECK(resumed.exit_code == 2);
  CHECK_THAT(resumed.standard_error, Contains("'p01' has no session to resume ('P01' has)"));
  CHECK(sql(directory, "SELECT count(*) FROM participant") == "1\n");
}

TEST_CASE("in a choice one switches freely and every visit is stored", "[end_to_end][threads]") {
  const TempDirectory directory;
  const auto result = session(directory, "reality_finger.yaml", "a\nb\nz\nC\n= c\n");
  INFO(result.standard_error);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.standard_error, !Contains("finite_elements"));  // blind
  CHECK(sql(directory, "SELECT group_concat(label) FROM alternative") == "A,B,C\n");
  CHECK(sql(directory,
            "SELECT response = (SELECT stimulus FROM alternative WHERE label = 'C') "
            "FROM response") == "1\n");
}

TEST_CASE("instructions, rests, confidence and feedback come in their places and are stored",
          "[end_to_end][threads]") {
  const TempDirectory directory;
  std::string text = testing::contents(paper("discrimination.yaml"));
  text.erase(text.find("\nhypotheses:"), text.find("\nsimulation:") - text.find("\nhypotheses:"));
  text = testing::replaced(text, "finger:\n", "instructions: Tap the plates.\n\nfinger:\n");
  text = testing::replaced(text, "    task: identification\n",
                           "    task: identification\n    practice: true\n    feedback: true\n"
                           "    instructions: Some practice first.\n"
                           "    confidence: {steps: 3, low: unsure, high: sure}\n"
                           "    breaks: {every_trials: 4}\n");
  testing::write(directory / "study.yaml", text);
  const auto run = testing::tapstudy({"run", directory / "study.yaml", "--participant", "P01",
                                      "--out", directory / "the_study", "--seed", "5"},
                                     "1\n9\n1\n2\n2\n3\n3\n4\n1\n1\n2\n2\n3\n3\n1\n4\n2\n");
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  CHECK_THAT(run.standard_error,
             Contains("Tap the plates.\n\nSome practice first.\n\nTrial 1 of 8 (practice)") &&
                 Contains("How sure are you? 1 (unsure) to 3 (sure)") &&
                 Contains("please type a number from 1 to 3") && Contains("right: it was ") &&
                 Contains("Time for a break"));
  CHECK(sql(directory, "SELECT group_concat(confidence) FROM response") == "1,2,3,1,2,3,1,2\n");
  CHECK(
      sql(directory,
          "SELECT group_concat(state) FROM session_event WHERE number = 5 OR "
          "number IS NULL") ==
      "begun,instructions,instructions,resting,ready,exploring,confirmed,confidence,saved,feedback,"
      "ended\n");
  CHECK(sql(directory,
            "SELECT count(*) FROM session_event AS a JOIN session_event AS b "
            "ON b.rowid = a.rowid + 1 WHERE b.t_s < a.t_s") == "0\n");
  CHECK_THAT(testing::contents((directory / "the_study") + "/answers.journal"),
             Contains("\"confidence\":3"));
}

TEST_CASE("without a participant's device a session is a rehearsal, and the report says so",
          "[end_to_end][threads]") {
  const TempDirectory directory;
  const auto result = session(directory, "reality_finger.yaml", "a\nb\nc\n= a\n");
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.standard_error, Contains("a rehearsal and stored as a pilot"));
  const auto report = testing::tapstudy({"report", directory / "the_study"});
  CHECK(report.exit_code == 0);
  CHECK_THAT(report.standard_output, Contains("PILOT sessions"));
}

TEST_CASE("whose row of the balanced orders somebody has, too, is told; one that is free is not",
          "[end_to_end][threads]") {
  const TempDirectory directory;
  testing::write(directory / "study.yaml", testing::text_with_blocks({"test"}, ""));
  const auto said = [&](const std::string& who, const std::string& answers,
                        const std::vector<std::string>& more = {}) {
    std::vector<std::string> line{"run",   directory / "study.yaml", "--participant", who,
                                  "--out", directory / "the_study"};
    line.insert(line.end(), more.begin(), more.end());
    return testing::tapstudy(line, answers).standard_error;
  };
  said("P01", "");  // answers nothing, and leaves the order to the next
  CHECK_THAT(said("P02", "1\n"), !Contains("of the balanced orders"));
  CHECK(sql(directory, "SELECT group_concat(order_index) FROM participant") == "0,0\n");
  const std::string told =
      "row 1 of the balanced orders, which this participant has, is P02's, too";
  CHECK_THAT(said("P03", "1\n", {"--row", "1"}), Contains(told));
  CHECK_THAT(said("P01", "1\n", {"--resume"}), Contains(told));
  CHECK_THAT(said("P04", "1\n"), !Contains("of the balanced orders"));
}

TEST_CASE("Ctrl-C in a session keeps what was answered and says how to go on",
          "[end_to_end][threads]") {
  const TempDirectory directory;
  // in the foreground: else the whole process group is told too, and a second signal ends at once
  const std::string script =
      "(echo 1; sleep 15) | /usr/bin/timeout --foreground --preserve-status -s INT 12 \"$0\" run "
      "\"$1\" --participant P01 --seed 5 --out \"$2\" 2>\"$3\"; echo $?; kill $(jobs -p) "
      "2>/dev/null";
  const auto result = testing::run_program(
      {"/bin/bash", "-c", "set -o pipefail; " + script, testing::tapstudy_program(),
       paper("discrimination.yaml"), directory / "the_study", directory / "said"});
  CHECK(result.standard_output == "130\n");
  CHECK_THAT(testing::contents(directory / "said"), Contains("--resume"));
  CHECK(sql(directory, "SELECT group_concat(number || status) FROM trial") ==
        "1answered,2interrupted\n");
  CHECK(sql(directory, "PRAGMA integrity_check") == "ok\n");
}

TEST_CASE("a rig that asks for more than its device can do, by its own words, is refused",
          "[end_to_end][safety]") {
  const auto [was, asked, said] = GENERATE(table<const char*, const char*, const char*>(
      {{"max_force_n: 5", "max_force_n: 6", "max_force_n: 6 N asked, 5 N by what 'example finger'"},
       {"workspace_radius_m: 0.05", "workspace_radius_m: 0.2", "workspace_radius_m: 0.2 m asked"},
       {"max_reply_s: 0.003", "max_reply_s: 0.003, max_sample_age_s: 0.0009",
        "max_sample_age_s: 0.0009 s asked, 0.001 s"}}));
  const TempDirectory directory;
  const std::uint16_t port = testing::free_port();
  const testing::ExampleBridge bridge{port};
  testing::write(
      directory / "rig.yaml",
      testing::replaced(
          testing::replaced(testing::contents(testing::shipped("rigs/remote.yaml")), was, asked),
          "port: 50607", fmt::format("port: {}", port)));
  const auto refused =
      testing::tapstudy({"run", paper("discrimination.yaml"), "--rig", directory / "rig.yaml",
                         "--participant", "P01", "--out", directory / "out"});
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.standard_error, Contains(said));
}

TEST_CASE("what the system refuses is named once by run, and by doctor with what to do about it",
          "[end_to_end]") {
  const TempDirectory directory;
  testing::write(
      directory / "rig.yaml",
      testing::contents(testing::shipped("rigs/simulated_hand.yaml")) + "\nloop: {cpu: 1023}\n");
  const auto run = testing::tapstudy({"run", paper("discrimination.yaml"), "--participant", "P01",
                                      "--out", directory / "out", "--rig", directory / "rig.yaml"},
                                     "1\n2\n3\n4\n1\n2\n3\n4\n");
  const std::string named = "the system refused processor 1023";
  CHECK_THAT(run.standard_error, Contains(named));
  CHECK(run.standard_error.find(named) == run.standard_error.rfind(named));
  const auto doctor =
      testing::tapstudy({"doctor", "--rig", directory / "rig.yaml", "--seconds", "0.1"});
  CHECK_THAT(doctor.standard_output,
             Contains("refused    processor 1023: another one for loop.cpu in the rig"));
}

TEST_CASE("a session runs on a device that another program drives, and can be replayed",
          "[end_to_end][threads][waits]") {
  const TempDirectory directory;
  const std::uint16_t port = testing::free_port();
  const testing::ExampleBridge bridge{port};
  testing::write(directory / "rig.yaml",
                 testing::replaced(testing::contents(testing::shipped("rigs/remote.yaml")),
                                   "port: 50607, max_reply_s: 0.003",
                                   fmt::format("port: {}, max_reply_s: 0.05", port)) +
                     "loop: {max_late_s: 1000, max_stall_s: 0.1, max_missed_share: 1}\n");
  // The bridge releases the force after 20 ms without a request, as on a busy machine: the session
  // is then interrupted, and resumed as people would.
  std::vector<std::string> command{
      "/usr/bin/python3",
      testing::source("tests/support/with_logind.py"),
      "/bin/bash",
      "-c",
      "for i in 1 2 3 4 1 2 3 4; do sleep 0.9; echo $i; done | \"$0\" run \"$1\" --rig \"$2\" "
      "--participant P01 --seed 5 --out \"$3\" $4",
      testing::tapstudy_program(),
      paper("discrimination.yaml"),
      directory / "rig.yaml",
      directory / "the_study"};
  auto live = testing::run_program(command);
  command.emplace_back("--resume");
  constexpr int interrupted = 3;
  for (int times = 0; live.exit_code == interrupted && times < 5; ++times) {
    live = testing::run_program(command);
  }
  INFO(live.standard_error);
  REQUIRE(live.exit_code == 0);
  CHECK_THAT(live.standard_output,
             Contains("inhibited: sleep:idle:handle-lid-switch tapstudy a haptic device is in use "
                      "block\nstill inhibited: 0"));
  CHECK_THAT(live.standard_error, Contains("The device says: a finger that is computed\n"));
  CHECK_THAT(sql(directory, "SELECT doctor FROM session"),
             Contains(R"("sleep":"sleep inhibited")"));
  CHECK(sql(directory, "SELECT DISTINCT doctor ->> '$.round_trip.count' FROM session") == "200\n");
  CHECK(sql(directory, "SELECT DISTINCT device FROM session") ==
        fmt::format("example finger, serial number 1, remote/3 at UDP port {}\n", port));
  CHECK(sql(directory, "SELECT count(*) FROM response") == "8\n");
  CHECK(sql(directory, "SELECT count(*) > 4 FROM event WHERE kind = 'impact'") == "1\n");

  std::string trial = sql(directory, "SELECT max(trial_id) FROM trial WHERE status = 'answered'");
  trial.pop_back();  // the end of the line
  testing::write(directory / "replay.yaml",
                 "format: tapstudy-rig/1\ndevice: replay\nmax_force_n: 5\n"
                 "max_force_rate_n_per_s: 5000\nreplay: {directory: the_study, trial_id: " +
                     trial + "}\n");
  const std::vector<std::string> replay{"run",           paper("discrimination.yaml"),
                                        "--rig",         directory / "replay.yaml",
                                        "--participant", "P02",
                                        "--out",         directory / "replayed"};
  const auto replayed = testing::tapstudy(replay, "1\n2\n3\n4\n1\n2\n3\n4\n");
  CHECK(replayed.exit_code == 0);
  CHECK_THAT(replayed.standard_error, Contains("a rehearsal and stored as a pilot"));
  CHECK(testing::run_program({"/usr/bin/sqlite3", directory / "replayed/study.db",
                              "SELECT device, mode FROM session JOIN participant "
                              "USING (participant_id)"})
            .standard_output ==
        "replay of trial " + trial + " of " + (directory / "the_study") + "|pilot\n");
}

TEST_CASE("report --mode takes the sessions that it names, and no others",
          "[end_to_end][threads]") {
  const TempDirectory directory;
  REQUIRE(session(directory, "reality_finger.yaml", "a\nb\nc\n= a\n", {"--pilot"}).exit_code == 0);
  REQUIRE(testing::tapstudy({"simulate", paper("reality_finger.yaml"), "--participants", "3",
                             "--out", directory / "the_study"})
              .exit_code == 0);
  const auto answers_of = [&](const std::string& mode) {
    const auto report = testing::tapstudy(
        {"report", directory / "the_study", "--mode", mode, "--out", directory / mode});
    return std::to_string(report.exit_code) + " " + report.standard_output + report.standard_error;
  };
  CHECK_THAT(answers_of("pilot"), Contains("0 ") && Contains("/1 "));
  CHECK_THAT(answers_of("simulated"), Contains("/3 ") && Contains("SIMULATED"));
  CHECK_THAT(answers_of("real"), Contains("2 ") && Contains("no answers of real participants"));
  CHECK_THAT(answers_of("dreamt"), Contains("2 "));
}

// What a session does when its context fail: nothing that was confirmed is lost.
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
             Catch::Matchers::StartsWith("5\n0\n") && Contains("report.html\nreport.json\n"));
}

TEST_CASE("a report that replaces a larger one names the files of it that stay", "[end_to_end]") {
  const TempDirectory directory;
  const auto result =
      shell(directory,
            "tapstudy simulate $study --participants 2 --seed 1 --out $out >/dev/null 2>&1\n"
            "tapstudy report $out --out reports >/dev/null 2>&1\n"
            "tapstudy report $out --out reports --replace >/dev/null 2>same\n"
            "tapstudy report $out --out reports --replace --only sessions >/dev/null 2>fewer\n"
            "grep -c 'stay there' same; grep 'stay there' fewer");
  CHECK_THAT(result.standard_output,
             Catch::Matchers::StartsWith("0\n") && Contains("reports: ") && Contains(".csv"));
}

TEST_CASE("a report of a study names the sessions that ended early", "[end_to_end]") {
  const TempDirectory directory;
  const auto result = shell(directory,
                            "printf '1\\n2\\n' | tapstudy run $study --participant P01 --out $out "
                            "2>/dev/null; tapstudy report $out");
  CHECK_THAT(result.standard_output, Contains("unfinished: P01: 2 of 8 trials"));
}

namespace {
// Consent first; the block `main` is for those who write with the left hand.
std::string screened_study(const TempDirectory& directory) {
  const std::string file = directory / "screened.yaml";
  std::string text = testing::contents(testing::source("tests/data/every_screen.yaml"));
  text = testing::replaced(
      text, "forms:\n",
      "forms:\n  consent:\n    title: Consent\n    items:\n"
      "      - {name: agree, kind: single_choice, question: \"Do you take part?\", "
      "options: [agreed, declined], ends_session: [declined], "
      "picture: {file: plates.svg, text: Two plates to tap}}\n"
      "      - {name: email, kind: text, question: \"Your address?\", required: false}\n");
  text = testing::replaced(text, "forms_before: [about]", "forms_before: [consent, about]");
  text = testing::replaced(text, "    instructions: Now",
                           "    presented_if: {form: about, item: hand, is: [left]}\n"
                           "    instructions: Now");
  testing::write(file, text);
  testing::write(directory / "plates.svg",
                 testing::contents(testing::source("tests/data/plates.svg")));
  return file;
}
}  // namespace

TEST_CASE("who declines is stored as such and nothing else, and leaves the order to the next",
          "[end_to_end][threads]") {
  const TempDirectory directory;
  const std::string study = screened_study(directory);
  const auto run = [&](const std::string& participant, const std::string& input,
                       const std::vector<std::string>& more = {}) {
    std::vector<std::string> line{"run",       study,   "--participant",
                                  participant, "--out", directory / "the_study"};
    line.insert(line.end(), more.begin(), more.end());
    return testing::tapstudy(line, input);
  };
  const auto declined = run("P01", "2\n");
  INFO(declined.standard_error);
  CHECK(declined.exit_code == 0);
  CHECK_THAT(declined.standard_output, Contains("takes no part: answered declined to 'agree'"));
  CHECK_THAT(declined.standard_error, Contains("[picture: Two plates to tap]\n"));
  CHECK(sql(directory, "SELECT item, answer FROM form_answer") == "agree|declined\n");
  CHECK(sql(directory, "SELECT count(*) FROM trial") == "0\n");
  CHECK(sql(directory, "SELECT state, detail FROM session_event ORDER BY rowid DESC LIMIT 1") ==
        "ended|declined to 'agree' of form 'consent'\n");
  const auto resumed = run("P01", "1\n", {"--resume"});
  CHECK(resumed.exit_code == 2);
  CHECK_THAT(resumed.standard_error, Contains("'P01' takes no part"));
  // pictures are inputs of the study: it goes on with those that it began with
  testing::write(directory / "plates.svg", "<svg/>");
  CHECK_THAT(run("P02", "").standard_error,
             Contains("'plates.svg' is not the file that the study"));
  testing::write(directory / "plates.svg",
                 testing::contents(testing::source("tests/data/plates.svg")));
  // right-handed, a glove among what was held, which is asked then; no trial of `main`
  const auto right = run("P02", "1\n\n\n2\n3, 2\na thick one\n1\n2\n");
  INFO(right.standard_error);
  CHECK(right.exit_code == 0);
  CHECK_THAT(right.standard_output, Contains("all 2 trials are stored"));
  CHECK(sql(directory, "SELECT answer FROM form_answer WHERE item IN ('held', 'glove')") ==
        "a glove;a hammer\na thick one\n");
  // left-handed; the session is stopped in `main` and gone on with
  CHECK(run("P03", "1\n\n\n1\n\n1\n2\n\n1\n2\n").exit_code == 130);
  const auto left = run("P03", "\n2\n3\n4\n0.75\n\n", {"--resume"});
  INFO(left.standard_error);
  CHECK(left.exit_code == 0);
  CHECK(sql(directory,
            "SELECT participant_id, order_index, (SELECT group_concat(DISTINCT block) FROM trial "
            "JOIN session AS s USING (session_id) WHERE s.participant_id = p.participant_id AND "
            "status = 'answered') FROM participant AS p") ==
        "P01|0|\nP02|0|practice\nP03|0|practice,main\n");
  const auto verified = testing::tapstudy({"verify", directory / "the_study"});
  INFO(verified.standard_output << verified.standard_error);
  CHECK(verified.exit_code == 0);
  const auto report = testing::tapstudy({"report", directory / "the_study"});
  INFO(report.standard_error);
  CHECK_THAT(report.standard_output,
             Contains("P01 took no part: answered declined to 'agree' of form 'consent'") &&
                 !Contains("unfinished"));
}
