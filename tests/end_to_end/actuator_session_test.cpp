// Sessions with an actuator beside the device, on a card that is a file.
#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/alsa_file.hpp"
#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using testing::TempDirectory;

namespace {
const std::string answers = "1\n2\n3\n4\n1\n2\n3\n4\n";

// The paper's plates, of which modes above 200 Hz are the actuator's.
std::string divided_study(const TempDirectory& directory) {
  const std::string file = directory / "study.yaml";
  const std::string slow = testing::replaced(
      testing::contents(testing::shipped("paper/discrimination.yaml")), "    repetitions: 2\n",
      "    repetitions: 2\n    explore: {min_seconds: 1}\n");
  testing::write(file, testing::replaced(slow, "band_limit_hz: 300",
                                         "band_limit_hz: 600\n  crossover_hz: [180, 200]"));
  return file;
}

std::string rig(const TempDirectory& directory, const std::string& actuator) {
  const std::string file = directory / "rig.yaml";
  testing::write(file, testing::contents(testing::shipped("rigs/simulated_hand.yaml")) +
                           "\nactuator: " + actuator + "\n");
  return file;
}

std::string sql(const TempDirectory& directory, const std::string& query) {
  return testing::run_program({"/usr/bin/sqlite3", (directory / "the_study") + "/study.db", query})
      .standard_output;
}

// Sounds with silence of 2 ms between them.
int sounds_in(const std::vector<double>& samples) {
  const std::size_t silence = 96;
  std::size_t silent = silence;
  int sounds = 0;
  for (const double sample : samples) {
    sounds += sample != 0.0 && silent >= silence ? 1 : 0;
    silent = sample == 0.0 ? silent + 1 : 0;
  }
  return sounds;
}
}  // namespace

TEST_CASE("each impact of a session is heard from the actuator, on its channel alone",
          "[end_to_end][audio][actuator]") {
  const TempDirectory directory;
  const std::string played = directory / "played.raw";
  const auto result = testing::tapstudy(
      {"run", divided_study(directory), "--participant", "P01", "--seed", "5", "--out",
       directory / "the_study", "--rig",
       rig(directory, fmt::format("{{card: \"{}\", channel: 2, full_scale_n: 20}}",
                                  testing::file_card(played)))},
      answers);
  INFO(result.standard_error);
  REQUIRE(result.exit_code == 0);
  CHECK(sql(directory,
            "SELECT count(DISTINCT trial_id), min(value), max(value) FROM event "
            "WHERE kind = 'actuator'") == "8|0.004|0.004\n");
  CHECK(sql(directory, "SELECT count(*) FROM event WHERE kind = 'actuator_lost'") == "0\n");
  CHECK(sounds_in(testing::channel_of(played, 0)) == 0);
  // a trial may end before its last impact is heard
  const int sounds = sounds_in(testing::channel_of(played, 1));
  const std::string impacts =
      "SELECT count(*) FROM event JOIN trial USING (trial_id) WHERE kind = 'impact'";
  CHECK(sounds >= std::stoi(sql(directory, impacts + " AND t_s < duration_s - 0.02")));
  CHECK(sounds >= 8);
  CHECK(testing::tapstudy({"verify", directory / "the_study"}).exit_code == 0);
}

TEST_CASE("a study that leaves vibration to an actuator is refused where none can render it",
          "[end_to_end][audio][actuator]") {
  const TempDirectory directory;
  const std::string study = divided_study(directory);
  const auto missing =
      testing::tapstudy({"run", study, "--participant", "P01", "--out", directory / "the_study",
                         "--rig", rig(directory, "{card: \"hw:31\", full_scale_n: 1}")},
                        answers);
  CHECK(missing.exit_code == 3);
  CHECK_THAT(missing.standard_error, Contains("audio: card 'hw:31' cannot be opened"));
  CHECK_FALSE(std::filesystem::exists(directory / "the_study"));
  const auto none =
      testing::tapstudy({"check", study, "--rig", testing::shipped("rigs/remote.yaml")});
  CHECK(none.exit_code == 2);
  CHECK_THAT(none.standard_error, Contains("the rig has no section 'actuator'"));
  const auto slow = testing::tapstudy(
      {"check", study, "--rig", rig(directory, "{rate_hz: 8000, full_scale_n: 1}")});
  CHECK(slow.exit_code == 0);
  CHECK_THAT(slow.standard_output, Contains("by the actuator"));
  testing::write(study, testing::replaced(testing::contents(study), "band_limit_hz: 600",
                                          "band_limit_hz: 3700"));
  const auto beyond = testing::tapstudy(
      {"check", study, "--rig", rig(directory, "{rate_hz: 8000, full_scale_n: 1}")});
  CHECK(beyond.exit_code == 2);
  CHECK_THAT(beyond.standard_error, Contains("actuator.rate_hz 8000 plays (at most 3600 Hz)"));
}
