#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace nlohmann::literals;

TEST_CASE("a simulated study takes the disk that check says it will", "[end_to_end]") {
  const testing::TempDirectory directory;
  const bool has_actuator = GENERATE(false, true);
  const std::string protocol = directory / "study.yaml";
  const std::string rig = directory / "rig.yaml";
  const std::string shipped = testing::contents(testing::shipped("paper/discrimination.yaml"));
  testing::write(protocol, has_actuator ? testing::replaced(shipped, "band_limit_hz: 300",
                                                            "band_limit_hz: 600\n"
                                                            "  crossover_hz: [180, 200]")
                                        : shipped);
  testing::write(rig, testing::contents(testing::shipped("rigs/simulated_hand.yaml")) +
                          (has_actuator ? "\nactuator: {full_scale_n: 20}\n" : ""));
  const auto check = testing::tapstudy({"check", protocol, "--participants", "6", "--rig", rig});
  std::smatch said;
  REQUIRE(std::regex_search(check.standard_output, said, std::regex{"about ([0-9.]+) MB of disk"}));
  REQUIRE(testing::tapstudy({"simulate", protocol, "--participants", "6", "--seed", "1", "--rig",
                             rig, "--out", directory / "s"})
              .exit_code == 0);
  const auto bytes = static_cast<double>(std::filesystem::file_size(directory / "s/study.db"));
  CHECK(1e-6 * bytes == Approx(std::stod(said[1])).epsilon(0.2));
}

TEST_CASE("verify notices what was changed of a study, its sessions or its statistics",
          "[end_to_end]") {
  const testing::TempDirectory directory;
  REQUIRE(testing::tapstudy({"simulate", testing::shipped("paper/discrimination.yaml").string(),
                             "--participants", "2", "--seed", "1", "--out", directory / "s"})
              .exit_code == 0);
  REQUIRE(testing::tapstudy({"verify", directory / "s"}).exit_code == 0);
  const auto [change, words] = GENERATE(table<std::string, std::string>(
      {{"participant SET mode = 'real'", "mode"},
       {"study SET protocol_text = replace(protocol_text, '3.2e9', '3.3e9')", "protocol_sha256"},
       {"session SET seed = seed + 1 WHERE session_id = 1", "seed"},
       {"session SET planned_order = planned_order || x'0a' WHERE session_id = 2", "planned_order"},
       {"tick_statistics SET saturated = saturated + 1 WHERE trial_id = 3", "saturated"}}));
  const auto changed = testing::run_program(
      {"/usr/bin/sqlite3", (directory / "s") + "/study.db", "UPDATE " + change});
  INFO(changed.standard_error);
  REQUIRE(changed.exit_code == 0);
  const auto verified = testing::tapstudy({"verify", directory / "s"});
  CHECK(verified.exit_code == 5);
  CHECK_THAT(verified.standard_output, Contains("differs: ") && Contains(words));
}

TEST_CASE("verify makes the report anew and names the numbers that were changed", "[end_to_end]") {
  const testing::TempDirectory directory;
  const std::string study = directory / "s";
  const auto simulate = [&](const char* participants) {
    return testing::tapstudy({"simulate", testing::shipped("paper/discrimination.yaml").string(),
                              "--participants", participants, "--seed", "1", "--out", study});
  };
  REQUIRE(simulate("3").exit_code == 0);
  REQUIRE(testing::tapstudy({"report", study}).exit_code == 0);
  const auto sound = testing::tapstudy({"verify", study});
  CHECK(sound.exit_code == 0);
  CHECK_THAT(sound.standard_output, Contains("identical to a regenerated report"));
  const std::string report = study + "/report/report.json";
  const auto json = nlohmann::json::parse(testing::contents(report));
  const auto changed = [&](const nlohmann::json::json_pointer& at) {
    nlohmann::json other = json;
    other[at] = other[at].get<int>() + 1;
    testing::write(report, other.dump());
    const auto verified = testing::tapstudy({"verify", study});
    CHECK(verified.exit_code == 5);
    CHECK_THAT(verified.standard_output, Contains("differs: report.json /blocks/"));
    testing::write(report, json.dump());
  };
  changed("/blocks/0/accuracy/successes"_json_pointer);
  changed("/blocks/0/counts/1/2"_json_pointer);
  CHECK(testing::tapstudy({"verify", study}).exit_code == 0);
  const std::string table = study + "/report/discrimination_confusion.csv";
  testing::write(table, testing::contents(table) + "x,0,0,0,0\n");
  const auto verified = testing::tapstudy({"verify", study});
  CHECK(verified.exit_code == 5);
  CHECK_THAT(verified.standard_output, Contains("discrimination_confusion.csv: is not"));
  std::filesystem::remove(table);
  nlohmann::json older = json;
  older["participants"] = 2;
  testing::write(report, older.dump());
  CHECK_THAT(testing::tapstudy({"verify", study}).standard_output,
             Contains("not compared: it was made of fewer participants"));
}

namespace {
void simulate(const std::string& out, const std::vector<std::string>& options = {}) {
  std::vector<std::string> arguments{
      "simulate",       testing::shipped("paper/discrimination.yaml"),
      "--participants", "2",
      "--seed",         "5",
      "--out",          out};
  arguments.insert(arguments.end(), options.begin(), options.end());
  REQUIRE(testing::tapstudy(arguments).exit_code == 0);
}
std::string query(const std::string& study, const std::string& sql) {
  return testing::run_program({"/usr/bin/sqlite3", study + "/study.db", sql}).standard_output;
}
}  // namespace

TEST_CASE("a study without traces has the answers and events of one with them", "[end_to_end]") {
  const testing::TempDirectory directory;
  simulate(directory / "traced");
  simulate(directory / "untraced", {"--no-traces"});
  const std::string same =
      "SELECT participant_id, trial.number, response, response_time_s, event.t_s, kind, value "
      "FROM trial JOIN session USING (session_id) JOIN response USING (trial_id) "
      "JOIN event USING (trial_id) WHERE kind <> 'untraced' "
      "ORDER BY participant_id, trial.number, event.t_s, kind";
  CHECK(query(directory / "traced", same).size() > 1000);
  CHECK(query(directory / "traced", same) == query(directory / "untraced", same));
  CHECK(query(directory / "untraced", "SELECT count(*) FROM trace_chunk") == "0\n");
  const auto verified = testing::tapstudy({"verify", directory / "untraced"});
  CHECK(verified.exit_code == 0);
  CHECK(testing::tapstudy({"report", directory / "untraced"}).exit_code == 0);
}

TEST_CASE("a trace that was removed is noticed", "[end_to_end]") {
  const testing::TempDirectory directory;
  simulate(directory / "study");
  query(directory / "study", "DELETE FROM trace_chunk WHERE trial_id = 3");
  const auto verified = testing::tapstudy({"verify", directory / "study"});
  CHECK(verified.exit_code != 0);
  CHECK_THAT(verified.standard_output + verified.standard_error,
             Contains("trial 3 ") && Contains("its trace is missing"));
}

// What an operator says of a session after it.
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
