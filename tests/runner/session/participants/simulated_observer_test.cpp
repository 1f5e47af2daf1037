// The simulated observer must earn its answers: it is given what a hand felt, never a name.
#include "runner/session/participants/simulated_observer.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "analysis/report/blocks/choices.hpp"
#include "analysis/report/confusion/confusion_summary.hpp"
#include "analysis/report/summary.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "core/haptics/haptic_state.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "results/store/store.hpp"
#include "results/store/study_queries.hpp"
#include "runner/studies/simulated_study.hpp"
#include "runner/studies/study_summary.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
// Which ticks make a tap that can be felt.
using namespace tapstudy;

namespace {
constexpr double dt_s = 1e-3;
constexpr double threshold_n = 1e-4;

// Alternately in contact and off, so many milliseconds each, beginning off.
std::vector<device::FeltTick> felt(const std::vector<int>& lengths_ms) {
  std::vector<device::FeltTick> ticks;
  bool is_contact = false;
  double x_m = 0.0;
  for (const int length : lengths_ms) {
    for (int i = 0; i < length; ++i) {
      device::FeltTick tick{};
      tick.hand.position_m = core::Vec3{x_m, 0.0, 0.0};
      tick.hand.position_m[core::normal_axis] = is_contact ? -0.001 : 0.01;
      tick.force_n = core::Vec3::Zero();
      tick.force_n[core::normal_axis] = is_contact ? 2.0 : 0.0;
      ticks.push_back(tick);
    }
    is_contact = !is_contact;
    x_m += 0.001;  // so that places tell contacts apart
  }
  return ticks;
}
std::vector<double> places_of_taps(const std::vector<int>& lengths_ms) {
  std::vector<double> places;
  for (const runner::FeltTap& tap : runner::felt_taps(felt(lengths_ms), dt_s, threshold_n)) {
    places.push_back(tap.place_m.x());
  }
  return places;
}
}  // namespace

TEST_CASE("a tap begins at its impact, also where the finger bounces", "[runner][observer]") {
  CHECK(places_of_taps({100, 200, 100}) == std::vector{0.001});
  CHECK(places_of_taps({100, 25, 10, 200, 100}) == std::vector{0.001});
  CHECK(places_of_taps({100, 25, 10, 20, 20, 200, 100}) == std::vector{0.001});
  CHECK(places_of_taps({100, 25, 60, 200, 100}) == std::vector{0.003});  // two touches
  CHECK(places_of_taps({100, 25, 10, 50, 100}).empty());                 // too short to feel
  CHECK(places_of_taps({100, 200, 100, 25, 10, 200, 100}) == std::vector{0.001, 0.003});
}

using analysis::ConfusionMatrix;
using analysis::Proportion;
using testing::replaced;

namespace {
std::string discrimination() {
  return testing::contents(testing::shipped("paper/discrimination.yaml"));
}
std::string with_noise(const std::string& db, std::string text = discrimination()) {
  return replaced(std::move(text), "noise_db: 14", "noise_db: " + db);
}
analysis::Summary simulated(const std::string& text, int participants, std::uint64_t seed = 7) {
  const testing::TempDirectory directory;
  const protocols::Protocol protocol = protocols::parse_protocol(text, "study.yaml");
  runner::simulate({"study.yaml", directory / "study", participants, seed}, protocol);
  results::Store store = results::Store::open_existing(directory / "study");
  return analysis::summarise(runner::design_of(protocol, results::Mode::simulated),
                             results::stored_answers(store), results::stored_visits(store));
}
const analysis::IdentificationSummary& identification(const analysis::Summary& summary) {
  return static_cast<const analysis::IdentificationSummary&>(*summary.blocks.at(0));
}
// Within four standard errors of guessing.
bool is_chance(const Proportion& accuracy, double chance) {
  const double error = std::sqrt(chance * (1.0 - chance) / static_cast<double>(accuracy.trials));
  return std::abs(accuracy.value() - chance) < 4.0 * error;
}
}  // namespace

TEST_CASE("four physically identical plates give chance", "[runner][observer][slow]") {
  std::string text = with_noise("1");
  for (const char* name : {"mdf_two", "mdf_three"}) {
    const auto at = text.find(std::string{"  "} + name + ":\n");
    const auto material = text.find("material: mdf", at);
    text.replace(material, 13, "material: acrylic");
  }
  for (int i = 0; i < 2; ++i) {
    text = replaced(text, "plate: three_fixations", "plate: two_fixations");
  }
  const analysis::Summary summary = simulated(text, 60);
  CHECK(is_chance(identification(summary).accuracy, 0.25));
}

TEST_CASE("an observer drowned in noise guesses", "[runner][observer][slow]") {
  CHECK(is_chance(identification(simulated(with_noise("1000"), 40)).accuracy, 0.25));
}

TEST_CASE("plates without vibration cannot be told apart", "[runner][observer][slow]") {
  std::string text = with_noise("1");
  for (int i = 0; i < 4; ++i) {
    text = replaced(text, "technique: fem", "technique: none");
  }
  CHECK(is_chance(identification(simulated(text, 40)).accuracy, 0.25));
}

TEST_CASE("shuffled labels give chance", "[runner][observer][slow]") {
  // the answers stay, but the names of the presented stimuli are permuted
  const testing::TempDirectory directory;
  const protocols::Protocol protocol = protocols::parse_protocol(with_noise("1"), "study.yaml");
  runner::simulate({"study.yaml", directory / "study", 40, 7}, protocol);
  results::Store store = results::Store::open_existing(directory / "study");
  auto answers = results::stored_answers(store);
  std::vector<std::string> names;
  for (const auto& answer : answers) {
    names.push_back(answer.stimulus);
  }
  core::Rng rng{3};
  rng.shuffle(names);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    answers[i].stimulus = names[i];
    answers[i].is_correct = answers[i].response == names[i];
  }
  const auto summary =
      analysis::summarise(runner::design_of(protocol, results::Mode::simulated), answers, {});
  CHECK(is_chance(identification(summary).accuracy, 0.25));
}

TEST_CASE("a quiet observer is nearly always right, and noise only makes it worse",
          "[runner][observer][slow]") {
  const double quiet = identification(simulated(with_noise("0.1"), 30)).accuracy.value();
  const double mild = identification(simulated(with_noise("4"), 30)).accuracy.value();
  const double noisy = identification(simulated(with_noise("16"), 30)).accuracy.value();
  CAPTURE(quiet, mild, noisy);
  CHECK(quiet > 0.8);
  CHECK(quiet > mild);
  CHECK(mild > noisy);
  CHECK(noisy > 0.25);
}

TEST_CASE("with little noise and little scatter the matrix is near diagonal",
          "[runner][observer][slow]") {
  const std::string text =
      replaced(with_noise("0.1"), "taps: {points: [P1, P2, P3, P4, P5], taps_per_visit: 10}",
               "taps: {points: [P4], taps_per_visit: 10, scatter_m: 0, speed_spread: 0.02}");
  const analysis::Summary summary = simulated(text, 30);
  const ConfusionMatrix& matrix = identification(summary).matrix;
  for (std::size_t i = 0; i < 4; ++i) {
    INFO(matrix.stimuli[i].name);
    CHECK(Proportion{matrix.counts[i][i], matrix.row_total(i)}.value() > 0.8);
  }
  CHECK(analysis::factor_accuracy(matrix, "structure").value() > 0.98);
}

TEST_CASE("material is confused more than structure, as in the paper's Table 2",
          "[runner][observer][slow]") {
  const auto summary = simulated(discrimination(), 60);
  const ConfusionMatrix& matrix = identification(summary).matrix;
  const double structure = analysis::factor_accuracy(matrix, "structure").value();
  const double material = analysis::factor_accuracy(matrix, "material").value();
  CHECK(structure > material + 0.1);
}

TEST_CASE("the observer chooses what feels like its reference", "[runner][observer][slow]") {
  const std::string text =
      with_noise("1", testing::contents(testing::shipped("paper/reality_vibration.yaml")));
  const auto chosen = [](const analysis::Summary& summary, const std::string& name) {
    const auto& choice = static_cast<const analysis::ChoiceSummary&>(*summary.blocks.at(0));
    for (const auto& alternative : choice.alternatives) {
      if (alternative.item.name == name) {
        return alternative.chosen.value();
      }
    }
    return -1.0;
  };
  CHECK(chosen(simulated(text, 20), "finite_elements") > 0.8);
  CHECK(chosen(simulated(replaced(text, "reference: finite_elements",
                                  "reference: finite_elements, reality: none"),
                         20),
               "no_vibration") > 0.8);
}

TEST_CASE("with nothing felt the answer is a guess", "[runner][observer]") {
  runner::SimulatedObserver observer{{core::Vec3::Zero()}, {1.0, 0.0, 1}, core::Rng{1}};
  const runner::FeltTap tap{core::Vec3::Zero(), {}};
  observer.remember("a", std::vector{tap});
  observer.remember("b", std::vector{tap});
  int first = 0;
  for (int i = 0; i < 1000; ++i) {
    first += observer.most_similar(std::vector<runner::FeltTap>{}, {"a", "b"}) == 0 ? 1 : 0;
  }
  CHECK(first == Approx(500).margin(4.0 * std::sqrt(250.0)));
}

TEST_CASE("techniques of one body are no different realities: telling them apart is chance",
          "[runner][observer][slow]") {
  std::string text = with_noise("1");
  for (const char* technique : {"none", "fem", "fem", "fem"}) {
    text = replaced(text, "technique: fem", std::string{"technique: "} + technique + " ");
  }
  for (const char* name : {"mdf_two", "mdf_three"}) {
    const auto at = text.find(std::string{"  "} + name + ":\n");
    text.replace(text.find("material: mdf", at), 13, "material: acrylic");
  }
  for (int i = 0; i < 2; ++i) {
    text = replaced(text, "plate: three_fixations", "plate: two_fixations");
  }
  CHECK(is_chance(identification(simulated(text, 60)).accuracy, 0.25));
}

TEST_CASE("what a simulated participant answers does not depend on what stimuli are called",
          "[runner][observer][slow]") {
  const auto answers_of = [](const std::string& text) {
    const testing::TempDirectory directory;
    const protocols::Protocol protocol = protocols::parse_protocol(text, "study.yaml");
    runner::simulate({"study.yaml", directory / "study", 4, 7}, protocol);
    std::vector<std::size_t> places;
    auto store = results::Store::open_existing(directory / "study");
    for (const auto& answer : results::stored_answers(store)) {
      const auto& names = protocol.blocks.at(0).stimuli;
      places.push_back(
          static_cast<std::size_t>(std::ranges::find(names, answer.response) - names.begin()));
    }
    return places;
  };
  std::string renamed = discrimination();
  for (const auto& [from, to] :
       {std::pair{"acrylic_two", "zebra"}, std::pair{"mdf_three", "ape"}}) {
    for (auto at = renamed.find(from); at != std::string::npos; at = renamed.find(from)) {
      renamed.replace(at, std::string{from}.size(), to);
    }
  }
  CHECK(answers_of(renamed) == answers_of(discrimination()));
}

TEST_CASE("simulated participants differ by more than chance between answers",
          "[runner][observer][slow]") {
  const auto variance_over_binomial = [](const std::string& people) {
    // many short trials each
    const std::string text =
        replaced(replaced(discrimination(), "repetitions: 2", "repetitions: 8"),
                 "taps_per_visit: 10", "taps_per_visit: 2");
    const auto summary = simulated(text + "  people: {" + people + "}\n", 30);
    const auto& participants = identification(summary).participants;
    double mean = 0.0;
    for (const auto& one : participants) {
      mean += one.accuracy.value() / static_cast<double>(participants.size());
    }
    double variance = 0.0;
    for (const auto& one : participants) {
      variance +=
          std::pow(one.accuracy.value() - mean, 2) / static_cast<double>(participants.size() - 1);
    }
    return variance /
           (mean * (1.0 - mean) / static_cast<double>(participants.front().accuracy.trials));
  };
  const double alike =
      variance_over_binomial("noise_spread: 0, threshold_spread: 0, speed_spread: 0, bias: 0");
  const double unlike = variance_over_binomial("noise_spread: 2, bias: 0");
  CAPTURE(alike, unlike);
  CHECK(alike < 1.0 + 3.0 * std::sqrt(2.0 / 29.0));
  CHECK(unlike > 2.0);
}

// What a simulated observer's internal noise makes of its thresholds.
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
    mesh: {{order: 1}}
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

// The threshold of participants who are all alike, as a level: of one fit of them all, since that
// of each is drawn down by the lapses that it could have.
double threshold_db(double internal_noise_db, const std::string& values, int participants = 10) {
  const std::string constant = fmt::format("{{constant: {{values: {}, repetitions: 24}}}}", values);
  const auto block = reported(internal_noise_db, constant, participants);
  return as_level_db(block->as_json().at("population").at(0).at("threshold").get<double>());
}

struct Recovered {
  std::vector<double> thresholds_db;  // of the runs that have one
  double trials{};                    // a run
};
// More of them by hand.
int runs_each() {
  const char* const asked = std::getenv("TAPSTUDY_RUNS");
  return asked == nullptr ? 60 : std::stoi(asked);
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
