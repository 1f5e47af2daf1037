// Sessions with an actuator beside the device, on a card that is a file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <filesystem>
#include <span>
#include <sstream>
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

// Of an exported file of an actuator's samples.
std::vector<double> commands_in(const std::string& file, double full_scale_n) {
  std::istringstream lines{testing::contents(file)};
  std::vector<double> samples;
  double heard_s = 0.0;
  double command_n = 0.0;
  for (std::string line; std::getline(lines, line);) {
    if (std::sscanf(line.c_str(), "%lf,%lf", &heard_s, &command_n) == 2) {
      samples.push_back(command_n / full_scale_n);
    }
  }
  return samples;
}

// Without the silence before and after.
std::span<const double> sound_of(const std::vector<double>& samples) {
  const auto is_heard = [](double sample) { return sample != 0.0; };
  const auto first = std::ranges::find_if(samples, is_heard);
  const auto last = std::find_if(samples.rbegin(), samples.rend(), is_heard);
  return first == samples.end() ? std::span<const double>{} : std::span{first, last.base()};
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
  const int sounds = sounds_in(testing::channel_of(played, 1));
  const std::string impacts =
      "SELECT count(*) FROM event JOIN trial USING (trial_id) WHERE kind = 'impact'";
  CHECK(sounds >= std::stoi(sql(directory, impacts)));
  CHECK(sounds >= 8);
  const auto verified = testing::tapstudy({"verify", directory / "the_study"});
  INFO(verified.standard_error << verified.standard_output);
  CHECK(verified.exit_code == 0);
  CHECK_THAT(verified.standard_output, Contains(" samples of actuators, rendered from the traces"));
  // the card's file is what it was given; each trial's samples are a part of it
  const auto exported = testing::tapstudy(
      {"export", directory / "the_study", "--out", directory / "out", "--traces"});
  REQUIRE(exported.exit_code == 0);
  const std::vector<double> given = testing::channel_of(played, 1);
  constexpr double step_of_card = 1.0 / 2147483647.0;
  for (int trial = 1; trial <= 8; ++trial) {
    const std::vector<double> stored =
        commands_in(directory / fmt::format("out/actuator/trial_{:06}.csv", trial), 20.0);
    const auto sound = sound_of(stored);
    CAPTURE(trial, stored.size(), sound.size());
    CHECK(sound.size() > 100);
    CHECK_FALSE(std::ranges::search(given, sound, [](double a, double b) {
                  return std::abs(a - b) <= step_of_card;
                }).empty());
  }
  const auto read = testing::run_program({"/usr/bin/python3",
                                          testing::source("tests/results/export/traces_match.py"),
                                          directory / "the_study", directory / "out"});
  INFO(read.standard_error);
  CHECK(read.exit_code == 0);
}

TEST_CASE("a simulated study has what an actuator would have been given, if its protocol says so",
          "[end_to_end][actuator]") {
  const TempDirectory directory;
  const std::string study = divided_study(directory);
  const std::string with = rig(directory, "{full_scale_n: 20}");
  const bool is_stored = GENERATE(true, false);
  if (!is_stored) {
    testing::write(study, testing::replaced(testing::contents(study), "crossover_hz:",
                                            "stores_actuator: false\n  crossover_hz:"));
  }
  const auto simulated = testing::tapstudy(
      {"simulate", study, "--participants", "1", "--rig", with, "--out", directory / "the_study"});
  INFO(simulated.standard_error);
  REQUIRE(simulated.exit_code == 0);
  CHECK(sql(directory, "SELECT count(*) FROM actuator") == (is_stored ? "8\n" : "0\n"));
  CHECK(testing::tapstudy({"verify", directory / "the_study"}).exit_code == 0);
  REQUIRE(testing::tapstudy({"export", directory / "the_study", "--format", "hdf5", "--out",
                             directory / "out.h5"})
              .exit_code == 0);
  const auto read = testing::run_program(
      {"/usr/bin/python3", testing::source("tests/results/export/hdf5_reader.py"),
       directory / "the_study", directory / "out.h5", "questionnaires"});
  INFO(read.standard_error);
  CHECK_THAT(read.standard_output, Contains(is_stored ? "8 trials of actuators" : "0 trials of"));
  CHECK(read.exit_code == 0);
  const auto refused =
      testing::tapstudy({"simulate", study, "--participants", "1", "--rig",
                         testing::shipped("rigs/remote.yaml"), "--out", directory / "another"});
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.standard_error, Contains("device: simulated_hand"));
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

TEST_CASE("doctor measures the actuator's card as it measures the loop",
          "[end_to_end][audio][actuator]") {
  const TempDirectory directory;
  const auto result = testing::tapstudy(
      {"doctor", "--seconds", "0.1", "--rig",
       rig(directory, fmt::format("{{card: \"{}\", full_scale_n: 20}}",
                                  testing::file_card(directory / "played.raw")))});
  CHECK_THAT(result.standard_output,
             Contains("48000 Hz: period 1.00 ms, buffer 3.00 ms, delay 4.00 ms"));
  CHECK_THAT(result.standard_output,
             Contains("jitter not measured") && Contains("ppm against the loop's"));
  CHECK_THAT(result.standard_output, Contains("its gaps   0 idle, 0 under load"));
  CHECK(sounds_in(testing::channel_of(directory / "played.raw", 0)) == 0);
}

namespace {
// What the card was given, 0.1 s later, and beside it what a low pass of one pole, y_n = 0.3 x_n +
// 0.7 y_(n-1), makes of it.
void record(const std::string& played, const std::string& table) {
  std::string text = "t_s,force,command\n";
  double y = 0.0;
  std::size_t n = 0;
  std::vector<double> samples(800, 0.0);
  for (const double sample : testing::channel_of(played, 0)) {
    samples.push_back(sample);
  }
  for (const double sample : samples) {
    y = 0.3 * sample + 0.7 * y;
    text += fmt::format("{:.9g},{:.9g},{:.9g}\n", static_cast<double>(n++) / 8000.0, y, sample);
  }
  testing::write(table, text);
}
}  // namespace

TEST_CASE("an actuator's response is measured by a sweep, as lines that its rig takes",
          "[end_to_end][audio][actuator]") {
  const TempDirectory directory;
  const std::string card =
      fmt::format("card: \"{}\", rate_hz: 8000, full_scale_n: 5, max_force_n: 2",
                  testing::file_card(directory / "played.raw"));
  const std::string file = rig(directory, "{" + card + "}");
  const auto with = [&](const std::string& force_n, const std::vector<std::string>& more) {
    std::vector<std::string> line{"calibrate-actuator", file,  "--seconds", "0.4",
                                  "--repeats",          "2",   "--to-hz",   "800",
                                  "--from-hz",          "100", "--force-n", force_n};
    line.insert(line.end(), more.begin(), more.end());
    return testing::tapstudy(line);
  };
  const auto loud = with("2.5", {"--play"});
  CHECK(loud.exit_code == 2);
  CHECK_THAT(loud.standard_error, Contains("above what the rig's limits allow, 2 N"));
  const auto playing = with("1.5", {"--play"});
  INFO(playing.standard_error);
  REQUIRE(playing.exit_code == 0);
  const std::vector<double> played = testing::channel_of(directory / "played.raw", 0);
  CHECK(std::ranges::max(played) == Approx(0.3).epsilon(0.01));  // 1.5 N of 5 N
  CHECK(sounds_in(testing::channel_of(directory / "played.raw", 1)) == 0);
  record(directory / "played.raw", directory / "recorded.csv");
  const auto found = with("1.5", {"--recording", directory / "recorded.csv", "--column", "force",
                                  "--reference-column", "command", "--newtons-per-unit", "5"});
  INFO(found.standard_error << found.standard_output);
  REQUIRE(found.exit_code == 0);
  CHECK_THAT(found.standard_output, Contains("phase_deg"));
  std::istringstream lines{found.standard_output};
  std::string flow;
  int points = 0;
  for (std::string line; std::getline(lines, line);) {
    double frequency_hz = 0.0;
    double gain = 0.0;
    double phase_deg = 0.0;
    if (std::sscanf(line.c_str(), "    - {frequency_hz: %lf, gain: %lf, phase_deg: %lf}",
                    &frequency_hz, &gain, &phase_deg) != 3) {
      continue;
    }
    const std::complex<double> expected =
        0.3 / (1.0 - 0.7 * std::polar(1.0, -2.0 * M_PI * frequency_hz / 8000.0));
    CAPTURE(line);
    CHECK(gain == Approx(std::abs(expected)).epsilon(0.02));
    CHECK(phase_deg == Approx(180.0 / M_PI * std::arg(expected)).margin(1.0));
    ++points;
    flow += fmt::format("{}{{frequency_hz: {}, gain: {}, phase_deg: {}}}", points > 1 ? ", " : "",
                        frequency_hz, gain, phase_deg);
  }
  CHECK(points == 24);
  const std::string calibrated =
      rig(directory, fmt::format("{{{}, response: {{points: [{}]}}}}", card, flow));
  CHECK(testing::tapstudy({"check", divided_study(directory), "--rig", calibrated}).exit_code == 0);
}
