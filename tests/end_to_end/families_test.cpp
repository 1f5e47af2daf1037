// --set at the command line, and families in check.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/psychometric_function.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/study_files.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
class Study {
 public:
  Study() {
    testing::write(
        file(), testing::varied_study_text_with(
                    {"youngs_modulus_pa: {from: 1e9, to: 4e9, spacing: log}",
                     "vibration_gain: {from: 0, to: 2}", "thickness_m: {values: [0.015, 0.03]}"}));
  }
  std::string file() const { return directory_ / "study.yaml"; }
  testing::ProgramResult run(const std::string& command,
                             const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{command, file(), "--stimulus", "a"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return testing::tapstudy(arguments);
  }
  nlohmann::json modes(std::vector<std::string> more) const {
    more.emplace_back("--json");
    const auto result = run("modes", more);
    INFO(result.standard_error);
    REQUIRE(result.exit_code == 0);
    return nlohmann::json::parse(result.standard_output);
  }

 private:
  testing::TempDirectory directory_;
};
}  // namespace

TEST_CASE("modes presents the member that --set asks for, and says its values",
          "[end_to_end][axes]") {
  const Study study;
  const auto own = study.modes({});
  CHECK(own["values"] == nlohmann::json{{"youngs_modulus_pa", 3.2e9},
                                        {"vibration_gain", 1.0},
                                        {"thickness_m", 0.02}});
  const auto softer = study.modes({"--set", "youngs_modulus_pa=1.6e9"});
  CHECK(softer["values"]["youngs_modulus_pa"] == 1.6e9);
  for (std::size_t i = 0; i < own["frequencies_hz"].size(); ++i) {
    CHECK(softer["frequencies_hz"][i].get<double>() ==
          Approx(std::sqrt(0.5) * own["frequencies_hz"][i].get<double>()).epsilon(1e-9));
  }
}

TEST_CASE("the nearest value of a table is presented, said and stored as what it is",
          "[end_to_end][axes]") {
  const Study study;
  const auto result = study.run("modes", {"--json", "--set", "thickness_m=0.02"});
  CHECK_THAT(result.standard_error,
             Contains("thickness_m is presented at 0.015, the nearest value of its table to 0.02"));
  CHECK(nlohmann::json::parse(result.standard_output)["values"]["thickness_m"] == 0.015);
  CHECK_THAT(study.run("modes", {"--json", "--set", "thickness_m=0.015"}).standard_error,
             !Contains("presented at"));
}

TEST_CASE("tap presents the member that --set asks for", "[end_to_end][axes]") {
  const Study study;
  const auto vibration = [&](const std::string& gain) {
    const auto result = study.run(
        "tap", {"--set", "vibration_gain=" + gain, "--at", "P", "--set", "youngs_modulus_pa=2e9"});
    INFO(result.standard_error);
    REQUIRE(result.exit_code == 0);
    CHECK_THAT(result.standard_output, Contains("youngs_modulus_pa 2000000000\n"));
    const std::string& text = result.standard_output;
    return std::stod(text.substr(text.find("vibration  ") + 9));
  };
  CHECK(vibration("0") == 0.0);
  CHECK(vibration("1") > 0.0);
}

TEST_CASE("a value that cannot be set is one clear error", "[end_to_end][axes]") {
  struct Refused {
    std::vector<std::string> more;
    const char* why;
  };
  const auto [more, why] = GENERATE(values<Refused>({
      {{"--set", "thickness=0.02"}, "is not an axis (one of: youngs_modulus_pa, density_kg_per_m3"},
      {{"--set", "thickness=0.02"}, "did you mean 'thickness_m'?"},
      {{"--set", "youngs_modulus_pa=5e9"}, "from 1000000000 to 4000000000 Pa"},
      {{"--set", "youngs_modulus_pa=nan"}, "nan is not allowed"},
      {{"--set", "youngs_modulus_pa=2e9x"}, "is not NAME=NUMBER"},
      {{"--set", "youngs_modulus_pa"}, "is not NAME=NUMBER"},
      {{"--set", "=1"}, "is not NAME=NUMBER"},
      {{"--set", ""}, "--set"},
      {{"--set", "vibration_gain=1", "--set", "vibration_gain=2"}, "is set twice"},
      {{"--set", "damping_scale=2"}, "does not vary in damping_scale"},
  }));
  const Study study;
  for (const char* command : {"tap", "modes"}) {
    const auto result = study.run(command, more);
    INFO(command << ": " << result.standard_error);
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.standard_error, Contains(why));
    CHECK(std::ranges::count(result.standard_error, '\n') == 1);
  }
}

TEST_CASE("an axis that the technique given instead does not use is refused",
          "[end_to_end][axes]") {
  const auto result = Study{}.run("tap", {"--technique", "none", "--set", "youngs_modulus_pa=2e9"});
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.standard_error, Contains("technique 'none' does not use it"));
}

TEST_CASE("check lists families with their models", "[end_to_end][axes]") {
  const Study study;
  const auto result = testing::tapstudy({"check", study.file()});
  INFO(result.standard_error);
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.standard_output,
             Contains("a: youngs_modulus_pa from 1000000000 to 4000000000 Pa; vibration_gain from "
                      "0 to 2; thickness_m 0.015, 0.03 m") &&
                 Contains("3 models, solved in "));
}

TEST_CASE("a member that cannot be built is refused at its `vary`, in one line",
          "[end_to_end][axes]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "study.yaml";
  const std::string text =
      testing::varied_study_text_with({"thickness_m: {values: [0.02, 0.0001]}"});
  testing::write(file, text);
  const auto result = testing::tapstudy({"check", file});
  INFO(result.standard_error);
  CHECK(result.exit_code == 4);
  const auto line =
      1 + std::count(text.begin(),
                     text.begin() + static_cast<std::ptrdiff_t>(text.find("thickness_m")), '\n');
  CHECK_THAT(result.standard_error, Contains("thickness_m = 0.0001"));
  const std::size_t at = result.standard_error.find(file + ":");
  REQUIRE(at != std::string::npos);
  // the mapping begins at its key or below it
  CHECK(std::abs(std::stoi(result.standard_error.substr(at + file.size() + 1)) - line) <= 1);
}

// A procedure that varies stimuli along two axes.
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
  const auto verified = testing::tapstudy({"verify", whole / "study"});
  INFO(verified.standard_output << verified.standard_error);
  CHECK(verified.exit_code == 0);
}

TEST_CASE("what a report says that a procedure estimated is Bayes' rule of the stored answers",
          "[end_to_end]") {
  const TempDirectory directory;
  session(directory, two_axes_study(directory), 8);
  REQUIRE(testing::tapstudy({"report", directory / "study"}).exit_code == 0);
  const auto report =
      nlohmann::json::parse(testing::contents((directory / "study") + "/report/report.json"));
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
