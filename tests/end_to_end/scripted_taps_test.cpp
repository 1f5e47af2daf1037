// Scripted taps: what a trial presents to a hand that holds the device still.
#include <cmath>
#include <sstream>

#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
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
