// A procedure that varies stimuli along two axes.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/psychometric_function.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using testing::TempDirectory;

namespace {
const std::vector<double> thresholds{0.1, 0.2, 0.4, 0.8};
const std::vector<double> effects{-0.004, 0.0, 0.004};
constexpr double slope = 2.0;
constexpr double guess = 0.5;
constexpr double lapse = 0.02;
constexpr double origin = 200.0;

std::string two_axes_study(const TempDirectory& directory) {
  const std::string file = directory / "study.yaml";
  std::string text = testing::contents(testing::source("tests/data/same_alternatives.yaml"));
  text = testing::replaced(text, "{sinusoid_amplitude_n_s_per_m: {from: 3, to: 6}}",
                           "{sinusoid_amplitude_n_s_per_m: {from: 3, to: 6}, "
                           "sinusoid_frequency_hz: {from: 150, to: 300}}");
  text = testing::replaced(
      text, "    procedures:\n      - constant: {values: [0.0], repetitions: 240}",
      "    axis: sinusoid_amplitude_n_s_per_m\n    further_axes: [sinusoid_frequency_hz]\n"
      "    procedures:\n      - quest_plus: {function: weibull, stimulus: {values: [0.1, 0.2, 0.4, "
      "0.8]}, threshold: {values: [0.1, 0.2, 0.4, 0.8]}, slope: {values: [2]}, guess: {values: "
      "[0.5]}, lapse: {values: [0.02]}, further_axes: [{values: [150, 200, 300], origin: 200, "
      "effect: {values: [-0.004, 0, 0.004]}}], stop: {trials: 8}}");
  testing::write(file, text);
  return file;
}

void session(const TempDirectory& directory, const std::string& study, int answers,
             const std::vector<std::string>& more = {}) {
  std::vector<std::string> line{
      "run", study, "--participant", "P01", "--out", directory / "study", "--seed", "5"};
  line.insert(line.end(), more.begin(), more.end());
  std::string input;
  for (int i = 0; i < answers; ++i) {
    input += "a\nb\n= a\n";
  }
  INFO(testing::tapstudy(line, input).standard_error);
}

std::string sql(const TempDirectory& directory, const std::string& query) {
  return testing::run_program(
             {"/usr/bin/sqlite3", "-separator", " ", (directory / "study") + "/study.db", query})
      .standard_output;
}

std::string presented(const TempDirectory& directory) {
  return sql(directory,
             "SELECT number, position, axis, round(value, 6) FROM axis_value JOIN trial USING "
             "(trial_id) WHERE status = 'answered' AND block = 'comparison' "
             "ORDER BY trial_id, position, axis");
}

struct Means {
  double threshold{};
  double effect{};
};

// By Bayes' rule, from the answers and what was presented, as stored; all priors are uniform.
Means posterior_means(const TempDirectory& directory) {
  Means sums;
  double total = 0.0;
  for (const double threshold : thresholds) {
    for (const double effect : effects) {
      std::istringstream rows{sql(
          directory,
          "SELECT is_correct, a.value / 3 - 1, f.value FROM trial JOIN response USING (trial_id) "
          "JOIN alternative USING (trial_id) JOIN axis_value AS a USING (trial_id, position) JOIN "
          "axis_value AS f USING (trial_id, position) WHERE is_comparison AND a.axis LIKE "
          "'%amplitude%' AND f.axis LIKE '%frequency%' AND block = 'comparison'")};
      double weight = 1.0;
      bool is_right = false;
      double level = 0.0;
      double frequency_hz = 0.0;
      while (rows >> is_right >> level >> frequency_hz) {
        const double p = core::proportion(
            core::PsychometricShape::weibull, level,
            threshold * std::pow(10.0, effect * (frequency_hz - origin)), slope, guess, lapse);
        weight *= is_right ? p : 1.0 - p;
      }
      total += weight;
      sums.threshold += weight * threshold;
      sums.effect += weight * effect;
    }
  }
  return {sums.threshold / total, sums.effect / total};
}

double reported_mean(const nlohmann::json& study, const std::string& parameter) {
  for (const nlohmann::json& row : study.at("procedure_posteriors")) {
    if (row.at("parameter") == parameter) {
      return row.at("mean");
    }
  }
  return std::nan("");
}
}  // namespace

TEST_CASE("alternatives of a trial share their value on a further axis, also in a resumed session",
          "[end_to_end][threads]") {
  const TempDirectory whole;
  const TempDirectory parts;
  const std::string study = two_axes_study(whole);
  session(whole, study, 8);
  session(parts, study, 3);
  session(parts, study, 5, {"--resume"});
  CHECK(sql(whole,
            "SELECT count(*), sum(low = high), sum(alternatives = 2) FROM (SELECT min(value) AS "
            "low, max(value) AS high, count(*) AS alternatives FROM axis_value JOIN trial USING "
            "(trial_id) WHERE axis = 'sinusoid_frequency_hz' AND block = 'comparison' AND status = "
            "'answered' GROUP BY trial_id)") == "8 8 8\n");
  CHECK(std::stoi(sql(whole,
                      "SELECT count(DISTINCT value) FROM axis_value WHERE axis = "
                      "'sinusoid_frequency_hz'")) > 1);
  CHECK(presented(parts) == presented(whole));
  CHECK(testing::tapstudy({"verify", whole / "study"}).exit_code == 0);
}

TEST_CASE("what a report says that a procedure estimated is Bayes' rule of the stored answers",
          "[end_to_end]") {
  const TempDirectory directory;
  session(directory, two_axes_study(directory), 8);
  REQUIRE(testing::tapstudy({"report", directory / "study"}).exit_code == 0);
  const auto report =
      nlohmann::json::parse(testing::contents((directory / "study") + "/report.json"));
  const Means means = posterior_means(directory);
  const nlohmann::json& study = report.at("study");
  CHECK(reported_mean(study, "threshold") == Approx(means.threshold).epsilon(1e-9));
  CHECK(reported_mean(study, "effect_2") == Approx(means.effect).epsilon(1e-9));
  CHECK(study.at("procedure_tracks").at(0).at("trials") == 8);
  const auto parts_of = [](const nlohmann::json& blocks) {
    return std::ranges::count_if(blocks, [](const nlohmann::json& block) {
      return block.at("block").get<std::string>().starts_with("comparison_at_");
    });
  };
  CHECK(parts_of(report.at("blocks")) > 1);
  REQUIRE(testing::tapstudy(
              {"report", directory / "study", "--only", "comparison", "--out", directory / "only"})
              .exit_code == 0);
  const auto only = nlohmann::json::parse(testing::contents((directory / "only") + "/report.json"));
  CHECK(parts_of(only.at("blocks")) == parts_of(report.at("blocks")));
  CHECK(std::ssize(only.at("blocks")) == parts_of(only.at("blocks")));
}
