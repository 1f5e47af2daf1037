// tapstudy as it is, in a process of its own, against SPIDARs that are plugged into a mocked
// kernel.
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
#include "support/processes.hpp"
#include "support/study_files.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

#if !TAPSTUDY_SANITIZED  // two libraries cannot both be the first to be loaded
namespace {
class Laboratory {
 public:
  Laboratory() { testing::write_patient_spidar_study(directory_); }
  testing::ProgramResult operator()(const std::vector<std::string>& options,
                                    const std::vector<std::string>& arguments) {
    std::vector<std::string> line{"/usr/bin/env", "LD_PRELOAD=libumockdev-preload.so.0",
                                  testing::lab_program(), directory_ / "report.json"};
    line.insert(line.end(), options.begin(), options.end());
    line.insert(line.end(), {"--", testing::tapstudy_program()});
    line.insert(line.end(), arguments.begin(), arguments.end());
    auto result = testing::run_program(line);
    std::ifstream written{directory_ / "report.json"};  // none if the mocked kernel gave up
    report = written ? nlohmann::json::parse(written) : nlohmann::json{};
    if (written) {  // the laboratory may fail while it is taken down, which is not tapstudy's end
      result.exit_code = report["exit_code"];
    }
    return result;
  }
  // The mocked kernel has one connection for the program and its guardian, and gives up where their
  // requests collide, which a kernel does not; and on a machine busy with other tests a guardian
  // may be silent for too long. Then the session is held once more.
  testing::ProgramResult session(const std::vector<std::string>& options) {
    constexpr int max_collisions = 8;
    testing::ProgramResult result;
    for (int i = 0; i < max_collisions; ++i) {
      out_ = directory_ / ("out_" + std::to_string(i));
      result = (*this)(options, {"run", directory_ / "study.yaml", "--rig", directory_ / "rig.yaml",
                                 "--participant", "P01", "--out", out_});
      const auto says = [&](const char* words) {
        return result.standard_error.find(words) != std::string::npos;
      };
      const bool is_guardian_killed = !options.empty() && options[0] == "--kill-guardian-in-trial";
      const bool is_guardian_late = says("the watchdog process has ended");
      const bool is_kernel_gone = says("libumockdev") || says("GLib-ERROR") || report.is_null();
      if (!is_kernel_gone && (is_guardian_killed || !is_guardian_late)) {
        break;
      }
    }
    return result;
  }
  std::string sql(const std::string& query) const {
    return testing::run_program({"/usr/bin/sqlite3", out_ + "/study.db", query}).standard_output;
  }
  nlohmann::json report;

 private:
  testing::TempDirectory directory_;
  std::string out_;
};
}  // namespace

TEST_CASE("what is plugged in is listed, with the way to get permission", "[end_to_end][usb]") {
  Laboratory laboratory;
  CHECK_THAT(laboratory({"--boards", "2"}, {"devices"}).standard_output,
             Contains("0cec:0205  /dev/bus/usb/001/007  SPIDAR-G6, SH4 board") &&
                 Contains("0cec:0205  /dev/bus/usb/001/008  SPIDAR-G6, SH4 board"));
  CHECK_THAT(laboratory({"--forbidden"}, {"devices"}).standard_output,
             Contains("no permission: install device/udev/70-tapstudy.rules"));
}

TEST_CASE("doctor tells how long the device takes to reply, and sends it no force",
          "[end_to_end][usb]") {
  Laboratory laboratory;
  const auto result = laboratory({}, {"doctor", "--seconds", "0.1"});
  CHECK_THAT(result.standard_output,
             Contains("  on device ") && Contains("requests to the device"));
  CHECK(laboratory.report["boards"][0]["requests"] == 100 + 3);  // and the guardian's
  CHECK(laboratory.report["boards"][0]["max_dac_counts"] == 0);
}

TEST_CASE("a device that cannot be used is one clear error, and no force is ever sent",
          "[end_to_end][usb][safety][waits]") {
  struct Case {
    std::vector<std::string> options;
    const char* said;
  };
  const auto [options, said] = GENERATE(values<Case>({
      {{"--boards", "0"}, "no SPIDAR-G6 is plugged in"},
      {{"--boards", "2"}, "2 SPIDAR-G6 are plugged in: say in the rig which"},
      {{"--forbidden"}, "no permission (copy device/udev/70-tapstudy.rules"},
      {{"--silent"}, "does not answer: no reply in time"},
      {{"--nonsense"}, "sent an invalid reply: the device echoed a command that was not sent"},
  }));
  Laboratory laboratory;
  const auto result = laboratory.session(options);
  CHECK(result.exit_code == 3);
  CHECK_THAT(result.standard_error, Contains(said));
  for (const auto& board : laboratory.report["boards"]) {
    CHECK(board["max_dac_counts"] == 0);
  }
}

TEST_CASE("a whole study runs through the USB stack", "[end_to_end][usb][slow][waits]") {
  Laboratory laboratory;
  const auto result = laboratory.session({});
  INFO(result.standard_error);
  REQUIRE(result.exit_code == 0);
  CHECK(laboratory.sql("SELECT count(*) FROM response") == "4\n");
  CHECK(laboratory.sql("SELECT device FROM session") ==
        "SPIDAR-G6 X3R, SH4 board, rotary switch 3\n");
  CHECK(laboratory.sql("SELECT doctor ->> '$.round_trip.count' FROM session") == "200\n");
  CHECK(laboratory.sql("SELECT count(DISTINCT number) FROM event JOIN trial USING (trial_id) "
                       "WHERE kind = 'impact'") == "4\n");
  CHECK(laboratory.sql("SELECT sum(dropped_samples) FROM tick_statistics") == "0\n");
  CHECK(laboratory.sql("PRAGMA integrity_check") == "ok\n");
  const auto& board = laboratory.report["boards"][0];
  CHECK(board["max_dac_counts"] > 150);  // a newton and more on a string
  CHECK(board["requests_without_force_at_the_end"] >= 3);
}

TEST_CASE("killed in the middle of a tap, the last the device gets is no force, three times",
          "[end_to_end][usb][safety][slow][waits]") {
  const int signal = GENERATE(SIGKILL, SIGSEGV);
  Laboratory laboratory;
  const auto result =
      laboratory.session({"--kill-in-trial", "1", "--signal", std::to_string(signal)});
  INFO(result.standard_error);
  CHECK(result.exit_code == 128 + signal);
  const auto& board = laboratory.report["boards"][0];
  CHECK(board["max_dac_counts"] > 50);
  // the mocked kernel may give the guardian the answer that the dead program did not read
  const int last = board["requests_without_force_at_the_end"];
  CHECK(last >= 3);
  const int before = laboratory.report["requests_before_trouble"];
  REQUIRE(before > 0);
  const int between = board["requests"].get<int>() - before - last;
  CHECK((between == 0 || between == 1));  // that was on its way when the signal was sent
  CHECK(laboratory.sql("PRAGMA integrity_check") == "ok\n");
}

TEST_CASE(
    "suspended in the middle of a tap, the program leaves no force on, and the trial is no answer",
    "[end_to_end][usb][safety][slow][waits]") {
  Laboratory laboratory;
  const auto result = laboratory.session({"--stop-in-trial", "1"});
  INFO(result.standard_error);
  REQUIRE(result.exit_code == 0);                                // the trial was repeated
  CHECK(laboratory.report["without_force_while_stopped"] > 50);  // every 5 ms, for a second
  CHECK(laboratory.sql(
            "SELECT status, fault LIKE '%stood still%' OR fault LIKE '%stalled%' FROM trial JOIN "
            "tick_statistics USING (trial_id) WHERE number = 1 ORDER BY attempt LIMIT 1") ==
        "interrupted|1\n");
  CHECK(laboratory.sql("SELECT count(*) FROM response") == "4\n");
}

TEST_CASE("an amplifier switched off in a tap ends the trial, and on again it is repeated",
          "[end_to_end][usb][safety][slow][waits]") {
  Laboratory laboratory;
  const auto result = laboratory.session({"--amplifier-off-in-trial", "1"});
  INFO(result.standard_error);
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.standard_error,
             Contains("the motors get no voltage (is the amplifier on?); force is off"));
  CHECK(laboratory.sql("SELECT count(*) FROM response") == "4\n");
}

TEST_CASE("a halted endpoint is cleared: force is off, and the trial is repeated",
          "[end_to_end][usb][safety][slow][waits]") {
  Laboratory laboratory;
  const auto result = laboratory.session({"--halt-in-trial", "1"});
  INFO(result.standard_error);
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.standard_error, Contains("the device's reply was broken; force is off"));
  CHECK(laboratory.sql("SELECT count(*) FROM response") == "4\n");
}

TEST_CASE("of a board that takes nothing, or takes all and has hung, force is never said to be off",
          "[end_to_end][usb][safety][slow][waits]") {
  Laboratory laboratory;
  const auto result = laboratory.session({GENERATE("--nak-in-trial", "--hang-in-trial"), "1"});
  INFO(result.standard_error);
  // before and after, a busy machine may interrupt the trial for its own reasons
  const std::string& all = result.standard_error;
  const auto warning = all.find("FORCE MAY STILL BE ON: SWITCH THE AMPLIFIER OFF");
  REQUIRE(warning != std::string::npos);
  const auto before = all.rfind("Check the device", warning);
  const auto begin = before == std::string::npos ? 0 : before;
  const auto end = all.find("Check the device", warning);
  CHECK_THAT(all.substr(begin, end - begin), !Contains("force is off"));
  CHECK(laboratory.report["boards"][0]["requests_without_force_at_the_end"] >= 3);
}

TEST_CASE("without its guardian the program renders no force",
          "[end_to_end][usb][safety][slow][waits]") {
  Laboratory laboratory;
  const auto result = laboratory.session({"--kill-guardian-in-trial", "1"});
  INFO(result.standard_error);
  REQUIRE(result.exit_code == 0);  // the device was opened anew, with another
  CHECK_THAT(result.standard_error, Contains("the watchdog process has ended"));
}

TEST_CASE("unplugged in a trial, all is kept, and plugged in again the trial is repeated",
          "[end_to_end][usb][safety][slow][waits]") {
  Laboratory laboratory;
  const auto result = laboratory.session({"--unplug-in-trial", "2"});
  INFO(result.standard_error);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.standard_error,
             Contains("trial 2: the device is gone; FORCE MAY STILL BE ON") &&
                 Contains("It is not there yet"));
  CHECK(laboratory.sql("SELECT number || ' ' || attempt || ' ' || status FROM trial "
                       "WHERE number = 2 ORDER BY attempt LIMIT 1") == "2 1 interrupted\n");
  CHECK(laboratory.sql("SELECT count(*) FROM response") == "4\n");
  // the grip of the second device is homed with its own counters
  CHECK(laboratory.report["boards"][1]["requests_without_force_at_the_end"] >= 3);
}
#endif
