// What a simulated observer's internal noise makes of its thresholds.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "analysis/statistics/quantiles.hpp"
#include "protocols/read_protocol.hpp"
#include "results/store.hpp"
#include "runner/experiments/simulated_study.hpp"
#include "runner/experiments/study_summary.hpp"
#include "runner/participants/touch_features.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
// Of a plate whose vibration is louder by fractions that a procedure chooses.
constexpr const char* study = R"(
format: tapstudy/1
title: Loudness of a vibration
finger: {{mass_kg: 0.058, stiffness_n_per_m: 300, damping_n_s_per_m: 3}}
rendering: {{rate_hz: 1000, band_limit_hz: 300, penalty_stiffness_n_per_m: 3000}}
placement: {{origin_m: [0, 0, 0], lateral_scale: 0.1}}
materials:
  mdf: {{youngs_modulus_pa: 2.5e9, density_kg_per_m3: 610, poissons_ratio: 0.25, damping: {{ratio: 0.02}}}}
plates:
  held:
    size_m: [0.3, 0.3, 0.05]
    fixations: [{{region: disc, at_m: [0.1, 0.1], radius_m: 0.02}}]
tapping_points_m: {{middle: [0, 0]}}
stimuli:
  plate: {{plate: held, material: mdf, technique: fem, vary: {{vibration_gain: {{from: 1, to: 10}}}}}}
blocks:
  - name: loudness
    task: comparison
    question: Which vibrates more?
    stimuli: [plate]
    procedures: [{procedure}]
simulation:
  taps: {{points: [middle], taps_per_visit: 4, visits: 1, speed_spread: 0}}
  observer: {{noise_db: {noise_db}, reality: fem}}
  people: {{noise_spread: 0, threshold_spread: 0, speed_spread: 0, bias: 0}}
)";

using Json = nlohmann::ordered_json;
constexpr double noise_db = 12.0;

// The report of the block, over simulated participants.
std::shared_ptr<const analysis::BlockSummary> reported(double internal_noise_db,
                                                       const std::string& procedure,
                                                       int participants) {
  const testing::TempDirectory directory;
  const std::string text =
      fmt::format(study, fmt::arg("noise_db", internal_noise_db), fmt::arg("procedure", procedure));
  const protocols::Protocol protocol = protocols::parse_protocol(text, "study.yaml");
  runner::simulate({"study.yaml", directory / "study", participants, 3, false}, protocol);
  results::Store store = results::Store::open_existing(directory / "study");
  return runner::summary_of_study({{directory / "study", &store}}, results::Mode::simulated,
                                  runner::Detail::main_results)
      .blocks.at(0);
}

double as_level_db(double fraction) {
  return 20.0 * std::log10(1.0 + fraction);
}

// The mean threshold of participants, as a level.
double threshold_db(double internal_noise_db, const std::string& values, int participants = 10) {
  const std::string constant = fmt::format("{{constant: {{values: {}, repetitions: 24}}}}", values);
  const auto block = reported(internal_noise_db, constant, participants);
  return as_level_db(block->main_results().at(0).estimate);
}

struct Recovered {
  std::vector<double> thresholds_db;  // of the runs that have one
  double trials{};                    // a run
};
// More of them by hand.
int runs_each() {
  const char* const asked = std::getenv("TAPSTUDY_RUNS");
  return asked == nullptr ? 100 : std::stoi(asked);
}

Recovered recovered(const std::string& procedure) {
  const int runs = runs_each();
  const Json report = reported(noise_db, procedure, runs)->as_json();
  Recovered all;
  for (const Json& run : report.at("participants")) {
    all.trials += run.at("correct_of").get<double>() / runs;
    if (run.at("threshold").is_number()) {
      all.thresholds_db.push_back(as_level_db(run.at("threshold").get<double>()));
    }
  }
  return all;
}
}  // namespace

// In 2AFC d' grows with the difference in decibels over the noise of a percept: the threshold is k
// times the noise. The hand adds next to none: it taps alike, and its spring is taken out.
TEST_CASE("thresholds of a simulated observer follow from its internal noise",
          "[runner][observer][slow]") {
  constexpr int participants = 24;
  const double at_6 = threshold_db(6.0, "[0.1, 0.2, 0.35, 0.6, 1.2]", participants);
  const double at_12 = threshold_db(noise_db, "[0.25, 0.5, 0.9, 1.6, 3]", participants);
  const double at_24 = threshold_db(24.0, "[0.5, 1, 2, 4, 8]", participants);
  fmt::print("  thresholds at 6, 12, 24 dB of noise: {:.2f}, {:.2f}, {:.2f} dB\n", at_6, at_12,
             at_24);
  // of n features that rise alike k = d' / sqrt n; at the threshold, 82 % right, d' is 1.27
  const double k = at_12 / 12.0;
  CHECK(k >= 1.27 / std::sqrt(2.0 * runner::bands));
  CHECK(k <= 1.27);
  CHECK(at_6 == Approx(6.0 * k).epsilon(0.15));
  CHECK(at_24 == Approx(24.0 * k).epsilon(0.15));
}

TEST_CASE("every procedure recovers the threshold of an observer who feels the taps",
          "[runner][observer][slow]") {
  const double expected_db = threshold_db(noise_db, "[0.1, 0.25, 0.5, 0.9, 1.6, 3, 6]", 30);
  const std::string grid =
      "function: weibull, stimulus: {min: 0.05, max: 9, count: 25, spacing: log}, threshold: {min: "
      "0.05, max: 9, count: 25, spacing: log}, slope: {values: [0.7, 1, 2, 3.5]}, stop: {trials: "
      "50}";
  const std::string steps =
      "steps: factor, start: 4, min: 0.05, max: 9, first_step: 2, min_step: 1.4, "
      "estimate_reversals: 6, stop: {trials: 50}";
  const std::vector<std::pair<std::string, std::string>> procedures{
      {"1 up 3 down", "{staircase: {rule: transformed, n_down: 3, " + steps + "}}"},
      {"weighted to 75 %", "{staircase: {rule: weighted, target: 0.75, " + steps + "}}"},
      {"QUEST+",
       "{quest_plus: {" + grid + ", guess: {values: [0.5]}, lapse: {values: [0.02, 0.05]}}}"}};
  for (const auto& [name, procedure] : procedures) {
    const Recovered runs = recovered(procedure);
    const double median_db = analysis::quantile(runs.thresholds_db, 0.5);
    const double spread_db = analysis::mean_and_spread(runs.thresholds_db).standard_deviation;
    fmt::print("  {}: {} of {} runs of {:.0f} trials, bias {:+.2f} dB, spread {:.2f} dB\n", name,
               runs.thresholds_db.size(), runs_each(), runs.trials, median_db - expected_db,
               spread_db);
    CAPTURE(name);
    CHECK(static_cast<double>(runs.thresholds_db.size()) >= 0.8 * runs_each());
    CHECK(median_db == Approx(expected_db).epsilon(0.2));
  }
}
