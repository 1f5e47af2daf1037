// Sessions with masking noise, on a card that is a file.
#include <fmt/format.h>

#include <cstdlib>
#include <sstream>

#include "support/alsa_file.hpp"
#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using testing::TempDirectory;

namespace {
const std::string answers = "1\n2\n3\n4\n1\n2\n3\n4\n";

std::string protocol(const TempDirectory& directory, const std::string& masking) {
  const std::string file = directory / "study.yaml";
  testing::write(file, testing::contents(testing::shipped("paper/discrimination.yaml")) +
                           "\nmasking: " + masking + "\n");
  return file;
}
std::string rig(const TempDirectory& directory, const std::string& audio) {
  const std::string file = directory / "rig.yaml";
  testing::write(file, testing::contents(testing::shipped("rigs/simulated_hand.yaml")) +
                           "\naudio: " + audio + "\n");
  return file;
}
std::vector<std::string> session(const TempDirectory& directory, const std::string& study,
                                 const std::string& audio) {
  return {"run", study,   "--participant",         "P01",   "--seed",
          "5",   "--out", directory / "the_study", "--rig", rig(directory, audio)};
}
std::string sql(const TempDirectory& directory, const std::string& query) {
  return testing::run_program({"/usr/bin/sqlite3", (directory / "the_study") + "/study.db", query})
      .standard_output;
}
std::string markers_of_masking(const TempDirectory& directory) {
  std::istringstream lines{testing::contents(directory / "markers.tsv")};
  std::string kinds;
  double t_s = 0.0;
  int trial = 0;
  std::string kind;
  std::string detail;
  while (lines >> t_s >> kind >> trial && std::getline(lines, detail)) {
    if (kind.starts_with("masking") || kind == "exploring" || kind == "confirmed") {
      kinds += kind + " ";
    }
  }
  return kinds;
}
void hear_with(const std::string& script) {
  const auto heard = testing::run_script("audio/" + script);
  INFO(heard.standard_output << heard.standard_error);
  CHECK(heard.exit_code == 0);
}
}  // namespace

TEST_CASE("markers tell when the noise is heard: from before go until after the answer",
          "[end_to_end][audio][markers]") {
  const TempDirectory directory;
  const auto result = testing::tapstudy(
      session(directory, protocol(directory, "{kind: white, level_db_fs: -20, ramp_s: 0.02}"),
              fmt::format("{{card: \"{}\"}}\nmarkers: {{lines: markers.tsv}}",
                          testing::file_card(directory / "played.raw"))),
      answers);
  INFO(result.standard_error);
  REQUIRE(result.exit_code == 0);
  std::string expected;
  for (int trial = 0; trial < 8; ++trial) {
    expected += "masking exploring confirmed masking_end ";
  }
  CHECK(markers_of_masking(directory) == expected);
}

TEST_CASE("every trial of a session has its noise, and says so", "[end_to_end][audio][threads]") {
  const TempDirectory directory;
  const std::string played = directory / "played.raw";
  const auto result = testing::tapstudy(
      session(directory, protocol(directory, "{kind: white, level_db_fs: -20, ramp_s: 0.02}"),
              fmt::format("{{card: \"{}\", gain_db: -4}}", testing::file_card(played))),
      answers);
  INFO(result.standard_error);
  REQUIRE(result.exit_code == 0);
  CHECK(sql(directory,
            "SELECT count(*), count(DISTINCT trial_id), min(value), max(value) FROM event "
            "WHERE kind = 'masking'") == "8|8|-24.0|-24.0\n");
  CHECK(sql(directory, "SELECT count(*) FROM event WHERE kind LIKE 'masking_%'") == "0\n");
  CHECK(testing::rms_db(testing::channel_of(played, 0)) == Approx(-24.0).margin(0.5));
  CHECK(testing::tapstudy({"verify", directory / "the_study"}).exit_code == 0);
}

TEST_CASE(
    "a client of JACK hears the noise at its level, spectrum and ramps, and every underrun; "
    "where JACK is killed no answer is lost",
    "[end_to_end][audio]") {
  setenv("TAPSTUDY_STALLING_PLAYER", testing::stalling_player_program().c_str(), 1);
  hear_with("jack_test.py");
}

TEST_CASE("a card of ALSA's is given the noise at its level, spectrum and ramps",
          "[end_to_end][audio]") {
  hear_with("alsa_file_test.py");
}

TEST_CASE("a session without a card is warned, or refused before anything is stored",
          "[end_to_end][audio]") {
  const TempDirectory directory;
  const auto refused = testing::tapstudy(
      session(directory, protocol(directory, "{kind: pink, level_db_fs: -20, is_required: true}"),
              "{card: \"hw:31\"}"),
      answers);
  CHECK(refused.exit_code == 3);
  CHECK_THAT(refused.standard_error, Contains("audio: card 'hw:31' cannot be opened") &&
                                         Contains("the protocol requires masking noise"));
  const auto warned =
      testing::tapstudy(session(directory, protocol(directory, "{kind: pink, level_db_fs: -20}"),
                                "{card: \"hw:31\"}"),
                        answers);
  CHECK(warned.exit_code == 0);
  CHECK_THAT(warned.standard_error, Contains("masking noise is not played: audio: card 'hw:31'"));
  CHECK(sql(directory, "SELECT count(*) FROM event WHERE kind LIKE 'masking%'") == "0\n");
  CHECK(sql(directory, "SELECT count(*) FROM session") == "1\n");
}

TEST_CASE("noise that a card cannot play is refused by check and by run", "[end_to_end][audio]") {
  const TempDirectory directory;
  const std::string loud = protocol(directory, "{kind: white, level_db_fs: -20}");
  const auto run = testing::tapstudy(session(directory, loud, "{gain_db: 9}"), answers);
  CHECK(run.exit_code == 2);
  CHECK_THAT(run.standard_error, Contains("is too loud (together at most -12 dB FS"));
  const std::string high =
      protocol(directory, "{kind: band, level_db_fs: -20, band_hz: [100, 8000]}");
  const auto check =
      testing::tapstudy({"check", high, "--rig", rig(directory, "{rate_hz: 16000}")});
  CHECK(check.exit_code == 2);
  CHECK_THAT(check.standard_error, Contains("masking.band_hz reaches 8000 Hz"));
}

TEST_CASE("check says what noise is played; a simulation plays none", "[end_to_end][audio]") {
  const TempDirectory directory;
  const std::string study = protocol(
      directory, "{kind: band, level_db_fs: -30, band_hz: [100, 1000], is_required: true}");
  const auto check = testing::tapstudy({"check", study});
  CHECK_THAT(check.standard_output, Contains("noise from 100 to 1000 Hz at -30 dB FS, ramps of "
                                             "0.5 s in every trial; required"));
  const auto simulated = testing::tapstudy(
      {"simulate", study, "--participants", "1", "--seed", "1", "--out", directory / "the_study"});
  CHECK(simulated.exit_code == 0);
  CHECK(sql(directory, "SELECT count(*) FROM event WHERE kind LIKE 'masking%'") == "0\n");
}
