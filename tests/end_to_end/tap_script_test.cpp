// `tap --script`: the simulated hand does what the script says, when it says it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
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
