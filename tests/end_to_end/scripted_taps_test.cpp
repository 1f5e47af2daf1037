// Scripted taps: what a trial presents to a hand that holds the device still.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
// `tap --script`: the simulated hand does what the script says, when it says it.
using namespace tapstudy;

namespace {
const std::string steps = R"(format: tapstudy-taps/1
steps:
  - {do: strike, point: P3, speed_m_s: 0.3, force_n: 1, start_s: 0.5}
  - {do: press, force_n: 4, duration_s: 0.2, start_s: 1}
  - {do: slide, place_m: [0.04, 0.24], speed_m_s: 0.2, start_s: 2}
  - {do: release, speed_m_s: 0.1, start_s: 4}
  - {do: strike, place_m: [0, 0], speed_m_s: 0.5, force_n: 0.5, start_s: 5}
rest_s: 1
)";

testing::ProgramResult tap(const testing::TempDirectory& directory, const std::string& script,
                           const std::vector<std::string>& more = {}) {
  testing::write(directory / "taps.yaml", script);
  std::vector<std::string> line{
      "tap",         testing::shipped("paper/reality_finger.yaml").string(),
      "--stimulus",  "both",
      "--technique", "none",
      "--csv",       "-",
      "--script",    directory / "taps.yaml"};
  line.insert(line.end(), more.begin(), more.end());
  return testing::tapstudy(line);
}

using Columns = std::map<std::string, std::vector<double>>;
Columns columns_of(const std::string& csv) {
  std::istringstream lines{csv};
  std::string line;
  std::getline(lines, line);
  std::vector<std::string> names;
  std::istringstream header{line};
  for (std::string name; std::getline(header, name, ',');) {
    names.push_back(name);
  }
  Columns columns;
  while (std::getline(lines, line)) {
    std::istringstream cells{line};
    for (const std::string& name : names) {
      std::string cell;
      std::getline(cells, cell, ',');
      columns[name].push_back(std::stod(cell));
    }
  }
  return columns;
}
std::size_t tick_at(double t_s) {
  return static_cast<std::size_t>(std::lround(t_s * 1000.0));
}
}  // namespace

TEST_CASE(
    "a scripted finger strikes, presses, slides and lifts where, when, how fast and how hard "
    "it should",
    "[end_to_end][tap_script]") {
  const testing::TempDirectory directory;
  const auto result = tap(directory, steps);
  INFO(result.standard_error);
  REQUIRE(result.exit_code == 0);
  const Columns trace = columns_of(result.standard_output);
  const auto value = [&](const std::string& name, double t_s) {
    return trace.at(name).at(tick_at(t_s));
  };
  const auto& impacts = trace.at("impact");
  const auto first = std::find(impacts.begin(), impacts.end(), 1.0) - impacts.begin();
  CHECK(std::abs(static_cast<double>(first) * 1e-3 - 0.5) < 0.0025);
  CHECK(trace.at("velocity_y_m_s").at(static_cast<std::size_t>(first)) ==
        Approx(-0.3).epsilon(0.01));
  CHECK(value("force_y_n", 0.99) == Approx(1.0).epsilon(0.02));
  CHECK(value("force_y_n", 1.9) == Approx(4.0).epsilon(0.01));
  CHECK(value("force_y_n", 3.9) == Approx(4.0).epsilon(0.01));
  // P3 is at x = 0.24; the plate is a tenth as large on the device
  const double scale = value("position_x_m", 1.9) / 0.24;
  CHECK(value("position_x_m", 2.5) / scale == Approx(0.24 - 0.2 * 0.5).epsilon(0.05));
  CHECK(value("position_x_m", 3.9) / scale == Approx(0.04).epsilon(1e-3));
  CHECK(value("force_y_n", 4.4) == 0.0);
  const auto second = std::find(impacts.begin() + 4500, impacts.end(), 1.0) - impacts.begin();
  CHECK(std::abs(static_cast<double>(second) * 1e-3 - 5.0) < 0.0025);
  CHECK(trace.at("velocity_y_m_s").at(static_cast<std::size_t>(second)) ==
        Approx(-0.5).epsilon(0.01));
  CHECK(std::abs(trace.at("position_x_m").at(static_cast<std::size_t>(second))) < 1e-4);
}

TEST_CASE("a script that no finger can do is refused with its lines", "[end_to_end][tap_script]") {
  const testing::TempDirectory directory;
  struct Case {
    const char* from;
    const char* to;
    const char* said;
  };
  const auto [from, to, said] = GENERATE(Catch::Generators::values<Case>({
      {"do: press", "do: push", "taps.yaml:4:"},
      {"point: P3", "point: P9", "steps[0].point: 'P9' is not a known tapping point"},
      {"point: P3", "point: P3, place_m: [0, 0]", "steps[0].place_m: stands beside point"},
      {"do: press, force_n: 4, duration_s: 0.2", "do: strike, point: P1, speed_m_s: 1, force_n: 1",
       "steps[1].do: strikes with a finger that is down (release it first)"},
      {"do: release, speed_m_s: 0.1", "do: release, speed_m_s: 0", "steps[3].speed_m_s: 0 is not"},
      {"force_n: 4, duration_s", "duration_s", "steps[1].force_n: is missing"},
      {"start_s: 5}", "start_s: 4.5}", "steps[4].start_s: 4.5 is too early"},
      {"start_s: 0.5}", "start_s: 0.1}",
       "taps.yaml:3:5: steps[0].start_s: 0.1 is too early (the finger is ready at 0.25 s)"},
      {"place_m: [0.04, 0.24]", "place_m: [0.4, 0.24]", "the finger leaves the plate after"},
      {"rest_s: 1", "rest: 1", "rest: is not a known key"},
  }));
  INFO(from << " → " << to);
  const auto result = tap(directory, testing::replaced(steps, from, to));
  CHECK(result.exit_code == 2);
  CHECK(result.standard_output.empty());
  CHECK_THAT(result.standard_error, Contains(said));
  CHECK(tap(directory, steps, {"--frames", directory / "x.svg"}).exit_code == 2);
}

using testing::TempDirectory;

namespace {
constexpr const char* scripted = "explore: {scripted_taps: {point: P3, speed_m_s: 0.3}}";

std::string sql(const TempDirectory& directory, const std::string& query) {
  return testing::run_program(
             {"/usr/bin/sqlite3", "-separator", " ", (directory / "study") + "/study.db", query})
      .standard_output;
}

// The paper's discrimination study, with other taps.
std::string study(const TempDirectory& directory, const std::string& explore,
                  const std::string& changed = "", const std::string& into = "") {
  std::string text = testing::contents(testing::source("protocols/paper/discrimination.yaml"));
  text = testing::replaced(text, "    task: identification\n",
                           "    task: identification\n    " + explore + "\n");
  if (!changed.empty()) {
    text = testing::replaced(text, changed, into);
  }
  testing::write(directory / "study.yaml", text);
  return directory / "study.yaml";
}

testing::ProgramResult simulated(const TempDirectory& directory, const std::string& file,
                                 const std::string& participants) {
  return testing::tapstudy({"simulate", file, "--participants", participants, "--seed", "3",
                            "--out", directory / "study"});
}
// The study whose alternatives are the same, with one that has a sinusoid and one that has none.
std::string with_and_without_sinusoid() {
  return testing::replaced(testing::contents(testing::source("tests/data/same_alternatives.yaml")),
                           "other: {plate: held, material: mdf, technique: sinusoid}",
                           "other: {plate: held, material: mdf, technique: none}");
}

double share_of_right_odd_ones(const TempDirectory& directory) {
  return std::stod(sql(directory,
                       "SELECT avg(is_correct) FROM current_response JOIN trial USING (trial_id) "
                       "WHERE block = 'odd_one_out'"));
}
}  // namespace

TEST_CASE("every scripted tap strikes alike, and the store says that they were scripted",
          "[end_to_end][scripted]") {
  const TempDirectory directory;
  REQUIRE(simulated(directory, study(directory, scripted), "3").exit_code == 0);
  std::istringstream first_impacts{
      sql(directory,
          "WITH strikes AS (SELECT trial_id, min(t_s) AS t_s, value FROM event WHERE kind = "
          "'impact' GROUP BY trial_id) SELECT count(*), max(value) - min(value), max(value), "
          "max(t_s) - min(t_s) FROM strikes")};
  int trials = 0;
  double spread = 1.0;
  double speed = 0.0;
  double jitter_s = 1.0;
  first_impacts >> trials >> spread >> speed >> jitter_s;
  CHECK(trials == 3 * 8);
  CHECK(spread < 1e-9);
  CHECK(speed == Approx(0.3).epsilon(0.02));
  CHECK(jitter_s < 1e-9);
  CHECK(sql(directory,
            "SELECT count(*) = (SELECT count(*) FROM trial) FROM event WHERE kind = "
            "'scripted_taps' AND value = 0.3") == "1\n");
  CHECK(testing::tapstudy({"verify", directory / "study"}).exit_code == 0);
}

TEST_CASE("in an interval as many scripted taps are felt of one alternative as of the other",
          "[end_to_end][scripted]") {
  const TempDirectory directory;
  const std::string text = testing::contents(testing::source("tests/data/same_alternatives.yaml"));
  testing::write(
      directory / "study.yaml",
      testing::replaced(text, "explore: {intervals: {seconds: 0.8, gap_seconds: 0.2}}",
                        "explore: {intervals: {seconds: 2, gap_seconds: 0.3}, "
                        "scripted_taps: {point: middle, speed_m_s: 0.2, pause_s: 0.3}}"));
  REQUIRE(simulated(directory, directory / "study.yaml", "1").exit_code == 0);
  const std::string of_each =
      sql(directory,
          "SELECT DISTINCT (SELECT count(*) FROM event AS tap WHERE tap.kind = 'impact' AND "
          "tap.trial_id = event.trial_id AND tap.t_s BETWEEN event.t_s AND event.t_s + 2.0) "
          "FROM event JOIN trial USING (trial_id) WHERE event.kind = 'interval' AND "
          "block = 'odd_one_out'");
  CHECK(of_each == "3\n");
}

TEST_CASE("who holds still tells a plate with a strong sinusoid from two without, by what is felt",
          "[end_to_end][scripted]") {
  const TempDirectory directory;
  std::string text = testing::replaced(
      with_and_without_sinusoid(), "one: {plate: held, material: mdf, technique: sinusoid}",
      "one: {plate: held, material: mdf, technique: sinusoid, rendering: "
      "{sinusoid_amplitude_n_s_per_m: 25}}");
  text =
      testing::replaced(text, "explore: {intervals: {seconds: 0.8, gap_seconds: 0.2}}",
                        "explore: {scripted_taps: {point: middle, speed_m_s: 0.2, dwell_s: 0.3}}");
  testing::write(directory / "study.yaml", text);
  REQUIRE(simulated(directory, directory / "study.yaml", "1").exit_code == 0);
  CHECK(share_of_right_odd_ones(directory) > 0.6);
}

TEST_CASE("who has planned more taps than an interval takes still feels every interval",
          "[end_to_end][scripted]") {
  const TempDirectory directory;
  testing::write(
      directory / "study.yaml",
      testing::replaced(with_and_without_sinusoid(), "taps_per_visit: 1", "taps_per_visit: 6"));
  REQUIRE(simulated(directory, directory / "study.yaml", "1").exit_code == 0);
  CHECK(share_of_right_odd_ones(directory) > 0.45);  // one in three by chance
}

TEST_CASE("scripted taps that cannot be are refused at their line", "[end_to_end][scripted]") {
  const TempDirectory directory;
  const auto error = [&](const std::string& explore) {
    const auto result = testing::tapstudy({"check", study(directory, explore)});
    CHECK(result.exit_code == 2);
    return result.standard_error;
  };
  CHECK_THAT(error("explore: {scripted_taps: {point: P9, speed_m_s: 0.3}}"),
             Contains("study.yaml:") && Contains("scripted_taps.point") && Contains("P9"));
  CHECK_THAT(error("explore: {scripted_taps: {point: P3}}"), Contains("speed_m_s"));
  CHECK_THAT(error("explore: {scripted_taps: {point: P3, speed_m_s: .nan}}"),
             Contains("speed_m_s"));
  CHECK_THAT(error("presented: real\n    explore: {scripted_taps: {point: P3, speed_m_s: 0.3}}"),
             Contains("real plates are tapped by hand"));
}

TEST_CASE("who is tapped for is told to hold still, and answers once it was felt",
          "[end_to_end][scripted]") {
  const TempDirectory directory;
  const auto result = testing::tapstudy({"run", study(directory, scripted), "--participant", "P01",
                                         "--out", directory / "study", "--seed", "5"},
                                        "1\n2\n3\n4\n1\n2\n3\n4\n");
  INFO(result.standard_error);
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.standard_error, Contains("hold the device still: the plate is tapped for you"));
  CHECK(sql(directory, "SELECT count(*) FROM current_response") == "8\n");
}

// Where taps are said to have landed.
namespace {
// The report's part on what was rendered, of a study's simulated or pilot sessions.
nlohmann::json rendered(const std::string& study, const std::string& mode) {
  const auto run = testing::tapstudy(
      {"report", study, "--mode", mode, "--only", "rendered", "--out", study + "_r"});
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  return nlohmann::json::parse(testing::contents(study + "_r/report.json"));
}
const nlohmann::json& points_of(const nlohmann::json& report) {
  return report.at("study").at("rendered_points");
}
}  // namespace

TEST_CASE("a report files each tap under the point that was tapped on the session's own placement",
          "[end_to_end]") {
  const TempDirectory directory;
  testing::write(directory / "rig.yaml",
                 testing::contents(testing::shipped("rigs/simulated_hand.yaml")) +
                     "placement: {origin_m: [0.01, 0.005, 0], lateral_scale: 0.02}\n");
  const std::string study = directory / "study";
  const auto run = testing::tapstudy(
      {"run", testing::shipped("paper/discrimination.yaml").string(), "--rig",
       directory / "rig.yaml", "--participant", "P01", "--out", study, "--seed", "5"},
      "1\n2\n3\n4\n1\n2\n3\n4\n");
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  const auto report = rendered(study, "pilot");
  for (const auto& point : points_of(report)) {
    CAPTURE(point.dump());
    // the hand scatters by a centimetre
    CHECK((point.at("taps") == 0 || point.at("distance_m") < 0.03));
  }
}

TEST_CASE("simulated taps land on the plate that is tapped, not within the bodies it stands on",
          "[end_to_end]") {
  const TempDirectory directory;
  const std::string study = directory / "study";
  const auto run =
      testing::tapstudy({"simulate", testing::shipped("examples/plate_on_feet.yaml").string(),
                         "--participants", "1", "--seed", "1", "--out", study});
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  const auto report = rendered(study, "simulated");
  REQUIRE(points_of(report).size() == 9);  // three mountings, three points
  for (const auto& point : points_of(report)) {
    CAPTURE(point.dump());
    CHECK(point.at("taps") > 0);
  }
}
