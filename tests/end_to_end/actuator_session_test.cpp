// Sessions with an actuator beside the device, on a card that is a file.
#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "support/alsa_file.hpp"
#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using testing::TempDirectory;

namespace {
constexpr double rate_hz = 48'000.0;
const std::string answers = "1\n2\n3\n4\n1\n2\n3\n4\n";

// The paper's plates, of which modes above 200 Hz are the actuator's.
std::string divided_study(const TempDirectory& directory) {
  const std::string file = directory / "study.yaml";
  testing::write(file, testing::replaced(
                           testing::contents(testing::shipped("paper/discrimination.yaml")),
                           "band_limit_hz: 300", "band_limit_hz: 600\n  crossover_hz: [180, 200]"));
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

double power_between(const std::vector<double>& samples, double low_hz, double high_hz) {
  double power = 0.0;
  for (double hz = low_hz; hz <= high_hz; hz += 5.0) {
    const std::complex<double> turn = std::polar(1.0, -2.0 * std::numbers::pi * hz / rate_hz);
    std::complex<double> phase{1.0, 0.0};
    std::complex<double> sum;
    for (const double sample : samples) {
      sum += sample * phase;
      phase *= turn;
    }
    power += std::norm(sum);
  }
  return power;
}
}  // namespace

TEST_CASE("an actuator plays what lies above the crossover, on its channel, in every trial",
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
  const auto silent = testing::channel_of(played, 0);
  const auto heard = testing::channel_of(played, 1);
  CHECK(testing::rms_db(silent) < -300.0);
  CHECK(power_between(heard, 220.0, 600.0) > 100.0 * power_between(heard, 40.0, 160.0));
  CHECK(testing::tapstudy({"verify", directory / "the_study"}).exit_code == 0);
}

TEST_CASE("a study that leaves vibration to an actuator is refused where none is, by its name",
          "[end_to_end][audio][actuator]") {
  const TempDirectory directory;
  const std::string study = divided_study(directory);
  const auto missing =
      testing::tapstudy({"run", study, "--participant", "P01", "--out", directory / "the_study",
                         "--rig", rig(directory, "{card: \"hw:31\", full_scale_n: 1}")},
                        answers);
  CHECK(missing.exit_code == 3);
  CHECK_THAT(missing.standard_error, Contains("audio: card 'hw:31' cannot be opened"));
  const auto slow = testing::tapstudy(
      {"check", study, "--rig", rig(directory, "{rate_hz: 8000, full_scale_n: 1}")});
  CHECK(slow.exit_code == 0);
  CHECK_THAT(slow.standard_output, Contains("by the actuator"));
}
