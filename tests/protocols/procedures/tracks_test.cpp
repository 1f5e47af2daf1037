// What holds of every procedure; constant stimuli; interleaved tracks.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "protocols/procedures/interleaved_tracks.hpp"
#include "protocols/procedures/quest_plus_track.hpp"
#include "support/catch.hpp"
#include "support/procedures.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using protocols::InterleavedTracks;
using Settings = std::shared_ptr<const protocols::TrackSettings>;

namespace {
const std::string constant =
    "constant: {values: [-2, -1, 0, 1, 2], repetitions: 4, order: shuffle}";
const std::string in_repetitions =
    "constant: {values: [-2, -1, 0, 1, 2], repetitions: 4, order: shuffle_within_repetition}";
const std::string staircase =
    "staircase: {rule: weighted, target: 0.75, steps: linear, start: 2, min: -3, max: 3, "
    "first_step: 0.5, min_step: 0.1, stop: {reversals: 8, trials: 40}, estimate_reversals: 4}";
const std::string psi =
    "psi: {function: logistic, stimulus: {min: -3, max: 3, count: 13}, threshold: {min: -2, max: "
    "2, count: 9}, slope: {min: 0.5, max: 4, count: 4, spacing: log}, guess: 0.5, lapse: 0.02, "
    "stop: {trials: 25}}";
const std::string quest_plus =
    "quest_plus: {function: logistic, stimulus: {min: -3, max: 3, count: 13}, threshold: {min: -2, "
    "max: 2, count: 9, prior: normal, mean: 0, sd: 1}, slope: {values: [1, 2]}, guess: {values: "
    "[0.5]}, lapse: {values: [0.02, 0.1], nuisance: true}, further_axes: [{values: [0, 1], effect: "
    "{values: [-1, 0, 1]}}], stop: {trials: 40, threshold_sd: 0.4}}";
const testing::KnownObserver::Parameters parameters{core::PsychometricShape::logistic, 0.2, 2.0,
                                                    0.5, 0.02};

struct Observed {
  std::vector<double> values;
  std::size_t outcome{};
};
}  // namespace

TEST_CASE("a replay of any number of trials asks for the same next value",
          "[protocols][procedures]") {
  for (const std::string& yaml : {constant, in_repetitions, staircase, psi, quest_plus}) {
    INFO(yaml);
    const Settings settings = testing::procedure_of(yaml);
    const auto track = settings->start(11);
    testing::KnownObserver observer{parameters, 3};
    std::vector<Observed> seen;
    while (const auto values = track->next()) {
      const auto replay = settings->start(11);
      for (const Observed& trial : seen) {
        replay->observe(trial.values, trial.outcome);
      }
      CHECK(replay->next() == values);
      CHECK(values->size() == settings->axes());
      seen.push_back({*values, observer.answer((*values)[0])});
      track->observe(seen.back().values, seen.back().outcome);
    }
    CHECK(track->is_finished());
    CHECK(track->trials() == seen.size());
    CHECK(seen.size() <= settings->max_trials());
    CHECK(track->summary().trials == seen.size());
    CHECK_THROWS_AS(track->observe(seen.back().values, 0), core::InvalidInput);
  }
}

TEST_CASE("a track takes only answers that there are", "[protocols][procedures]") {
  for (const std::string& yaml : {constant, staircase, psi}) {
    const auto track = testing::procedure_of(yaml)->start(1);
    const auto before = track->next();
    CHECK_THROWS_AS(track->observe({1.0}, 2), core::InvalidInput);
    CHECK_THROWS_AS(track->observe({1.0, 1.0}, 1), core::InvalidInput);
    CHECK_THROWS_AS(track->observe({std::nan("")}, 1), core::InvalidInput);
    CHECK(track->trials() == 0);
    CHECK(track->next() == before);
  }
}

TEST_CASE("constant stimuli come as often as the repetitions say, in each repetition once",
          "[protocols][procedures]") {
  for (const std::string& yaml : {constant, in_repetitions}) {
    const auto track = testing::procedure_of(yaml)->start(5);
    std::map<double, int> counts;
    testing::run(*track, [&](const std::vector<double>& values) -> std::size_t {
      ++counts[values[0]];
      if (yaml == in_repetitions && track->trials() % 5 == 4) {
        const auto first = counts.begin()->second;
        CHECK(std::ranges::all_of(counts, [&](const auto& one) { return one.second == first; }));
      }
      return 1;
    });
    CHECK(counts == std::map<double, int>{{-2, 4}, {-1, 4}, {0, 4}, {1, 4}, {2, 4}});
  }
}

TEST_CASE("constant stimuli come in every order equally often", "[protocols][procedures]") {
  const Settings settings =
      testing::procedure_of("constant: {min: 1, max: 3, count: 3, repetitions: 1}");
  std::map<std::vector<double>, int> orders;
  for (std::uint64_t seed = 0; seed < 6000; ++seed) {
    const auto track = settings->start(seed);
    std::vector<double> order;
    testing::run(*track, [&](const std::vector<double>& values) -> std::size_t {
      order.push_back(values[0]);
      return 0;
    });
    ++orders[order];
  }
  CHECK(orders.size() == 6);
  for (const auto& [order, count] : orders) {
    CHECK(count == Approx(1000).margin(115));  // four standard deviations
  }
}

TEST_CASE("values between min and max are equally far apart, or by equal factors",
          "[protocols][procedures]") {
  for (const bool is_log : {false, true}) {
    const auto track =
        testing::procedure_of(fmt::format("constant: {{min: 0.3, max: 7, count: 5, spacing: {}, "
                                          "repetitions: 1, order: shuffle}}",
                                          is_log ? "log" : "linear"))
            ->start(1);
    std::set<double> values;
    testing::run(*track, [&](const std::vector<double>& own) -> std::size_t {
      values.insert(own[0]);
      return 0;
    });
    REQUIRE(values.size() == 5);
    CHECK(*values.begin() == 0.3);
    CHECK(*values.rbegin() == 7.0);  // 0.3 (7 / 0.3) is not 7
    for (auto next = std::next(values.begin()); next != values.end(); ++next) {
      const double before = *std::prev(next);
      // values have 12 digits
      CHECK((is_log ? *next / before : *next - before) ==
            Approx(is_log ? std::pow(7.0 / 0.3, 0.25) : 6.7 / 4.0).epsilon(1e-11));
    }
  }
}

TEST_CASE("interleaved tracks are drawn as PCG32 and SplitMix64 say, on any compiler",
          "[protocols][procedures]") {
  // by Python's integers; three tracks that go on
  const auto run =
      testing::run_program({"/usr/bin/python3", "-c", R"(
import sys
M = 2**64 - 1
def mixed(x):
    x = (x + 0x9e3779b97f4a7c15) & M
    x = ((x ^ x >> 30) * 0xbf58476d1ce4e5b9) & M
    x = ((x ^ x >> 27) * 0x94d049bb133111eb) & M
    return x ^ x >> 31
def below(seed, n):
    state = 0
    def draw():
        nonlocal state
        old, state = state, (state * 6364136223846793005 + 1442695040888963407) & M
        word, turn = (old >> 18 ^ old) >> 27 & 0xffffffff, old >> 59
        return (word >> turn | word << (32 - turn)) & 0xffffffff
    draw()
    state = (state + seed) & M
    draw()
    while True:
        r = draw()
        if r >= 2**32 % n:
            return r % n
for trial in range(200):
    print(below(mixed(mixed(mixed(2024) ^ int(sys.argv[1])) ^ trial), 3))
)",
                            std::to_string(static_cast<int>(core::Purpose::interleaving))});
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  std::istringstream theirs{run.standard_output};
  const Settings endless = testing::procedure_of("constant: {values: [1, 2], repetitions: 500}");
  InterleavedTracks tracks{{endless, endless, endless}, 2024};
  for (int trial = 0; trial < 200; ++trial) {
    std::size_t expected = 0;
    REQUIRE(theirs >> expected);
    const auto request = tracks.next();
    CHECK(request->track == expected);
    tracks.observe(request->values, 1);
  }
}

TEST_CASE("interleaved tracks depend on seed and answers alone, and run each to its end",
          "[protocols][procedures]") {
  const std::vector<Settings> all{testing::procedure_of(constant), testing::procedure_of(staircase),
                                  testing::procedure_of(staircase), testing::procedure_of(psi)};
  InterleavedTracks tracks{all, 9};
  testing::KnownObserver observer{parameters, 4};
  std::vector<Observed> seen;
  std::vector<std::size_t> order;
  while (const auto request = tracks.next()) {
    CHECK_FALSE(tracks.track(request->track).is_finished());
    InterleavedTracks replay{all, 9};
    for (const Observed& trial : seen) {
      replay.observe(trial.values, trial.outcome);
    }
    REQUIRE(replay.next());
    CHECK(replay.next()->track == request->track);
    CHECK(replay.next()->values == request->values);
    seen.push_back({request->values, observer.answer(request->values[0])});
    order.push_back(request->track);
    tracks.observe(seen.back().values, seen.back().outcome);
  }
  CHECK_THROWS_AS(tracks.observe({0.0}, 1), core::InvalidInput);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    CHECK(tracks.track(i).is_finished());
    CHECK(tracks.track(i).trials() == static_cast<std::size_t>(std::ranges::count(order, i)));
  }
  // the two staircases are not told apart by anything but their own answers
  CHECK(tracks.track(0).trials() == 20);
  CHECK(tracks.track(3).trials() == 25);
}

// QUEST+ on observers whose psychometric function is known.
namespace {
constexpr int runs = 200;
const testing::KnownObserver::Parameters two_alternatives{core::PsychometricShape::gumbel, 0.13,
                                                          3.5, 0.5, 0.02};

std::string quest_plus_of(int trials, const std::string& stop = "") {
  return fmt::format(
      "quest_plus: {{function: gumbel, stimulus: {{min: -1.5, max: 1.5, count: 31}}, "
      "threshold: {{min: -1, max: 1, count: 41}}, slope: {{values: [2, 3.5, 5]}}, "
      "guess: {{values: [0.5]}}, lapse: {{values: [0.02]}}, stop: {{trials: {}{}}}}}",
      trials, stop);
}

struct Spread {
  double mean{};
  double deviation{};
  double trials{};
};
Spread estimates(const std::string& yaml) {
  const auto settings = testing::procedure_of(yaml);
  Spread all;
  double square = 0.0;
  for (std::uint64_t seed = 1; seed <= runs; ++seed) {
    testing::KnownObserver observer{two_alternatives, seed};
    const auto track = settings->start(seed);
    testing::run(*track, [&](const auto& values) { return observer.answer(values[0]); });
    const double estimate = track->summary().estimate.value();
    all.mean += estimate / runs;
    square += estimate * estimate / runs;
    all.trials += static_cast<double>(track->trials()) / runs;
  }
  all.deviation = std::sqrt((square - all.mean * all.mean) * runs / (runs - 1));
  return all;
}
}  // namespace

TEST_CASE("QUEST+ finds the threshold, with fewer trials than a staircase of the same spread",
          "[protocols][procedures]") {
  const Spread bayes = estimates(quest_plus_of(40));
  const Spread steps = estimates(
      "staircase: {rule: transformed, n_down: 2, steps: linear, start: 1, min: -1.5, max: 1.5, "
      "first_step: 0.4, min_step: 0.05, stop: {trials: 80}, estimate_reversals: 8}");
  CAPTURE(bayes.mean, bayes.deviation, steps.mean, steps.deviation, steps.trials);
  CHECK(bayes.mean ==
        Approx(two_alternatives.threshold).margin(4 * bayes.deviation / std::sqrt(runs)));
  CHECK(bayes.trials < 0.6 * steps.trials);
  CHECK(bayes.deviation < steps.deviation);
  const testing::KnownObserver known{two_alternatives, 1};
  CHECK(steps.mean == Approx(known.value_at(std::sqrt(0.5))).margin(0.05));
}

TEST_CASE("QUEST+ stops once the posterior is as narrow as asked", "[protocols][procedures]") {
  const auto settings = testing::procedure_of(quest_plus_of(200, ", threshold_sd: 0.08"));
  testing::KnownObserver observer{two_alternatives, 8};
  const auto track = settings->start(1);
  double before = 0.0;
  testing::run(*track, [&](const auto& values) {
    before = track->summary().parameters[0].standard_deviation;
    return observer.answer(values[0]);
  });
  CHECK(track->trials() < 200);
  CHECK(before > 0.08);
  CHECK(track->summary().parameters[0].standard_deviation <= 0.08);
}

TEST_CASE("the psi method is QUEST+ with guess and lapse rate fixed", "[protocols][procedures]") {
  const std::string common =
      "function: cumulative_gaussian, stimulus: {min: -2, max: 2, count: 17}, threshold: {min: -1, "
      "max: 1, count: 9}, slope: {values: [1, 2, 4], prior: normal, mean: 2, sd: 1}, stop: "
      "{trials: 30}";
  const auto psi =
      testing::procedure_of("psi: {guess: 0.25, lapse: 0.03, " + common + "}")->start(1);
  const auto general =
      testing::procedure_of("quest_plus: {guess: {values: [0.25]}, lapse: {values: [0.03]}, " +
                            common + "}")
          ->start(1);
  testing::KnownObserver observer{two_alternatives, 2};
  testing::run(*psi, [&](const std::vector<double>& values) {
    CHECK(general->next() == values);
    const std::size_t outcome = observer.answer(values[0]);
    general->observe(values, outcome);
    return outcome;
  });
  CHECK(psi->summary().estimate == general->summary().estimate);
}

TEST_CASE("QUEST+ learns from the value that was presented, on its grid or not",
          "[protocols][procedures]") {
  const auto track = testing::procedure_of(
                         "quest_plus: {function: logistic, stimulus: {values: [0, 1]}, threshold: "
                         "{values: [0, 1]}, slope: {values: [2]}, guess: {values: [0]}, lapse: "
                         "{values: [0]}, stop: {trials: 3}}")
                         ->start(1);
  track->observe({0.3}, 1);
  const testing::KnownObserver low{{core::PsychometricShape::logistic, 0.0, 2.0}, 1};
  const testing::KnownObserver high{{core::PsychometricShape::logistic, 1.0, 2.0}, 1};
  // Bayes' rule of two hypotheses, 0 and 1; the mean is the probability of the second
  CHECK(track->summary().estimate.value() ==
        Approx(high.probability(0.3) / (low.probability(0.3) + high.probability(0.3))));
}

TEST_CASE("an answer that no parameters allow is refused and changes nothing",
          "[protocols][procedures]") {
  const auto track = testing::procedure_of(
                         "quest_plus: {function: weibull, stimulus: {values: [1, 2]}, threshold: "
                         "{values: [1, 2]}, slope: {values: [5]}, guess: {values: [0.5]}, lapse: "
                         "{values: [0]}, stop: {trials: 3}}")
                         ->start(1);
  const auto before = track->next();
  CHECK_THROWS_WITH(track->observe({1000.0}, 0), Contains("impossible"));
  CHECK_THROWS_AS(track->observe({-1.0}, 0), core::InvalidInput);
  CHECK(track->trials() == 0);
  CHECK(track->next() == before);
}

// QUEST+ against python3-questplus (Debian), by answers to stimuli drawn at random.
using json = nlohmann::ordered_json;  // the order of parameters is that of the posterior
using protocols::LikelihoodTable;
using protocols::QuestPlusTrack;

namespace {
constexpr int sequences_of_each = 50;
constexpr double precision = 1e-12;
const std::string folder = "tests/protocols/procedures/";

using Table = std::shared_ptr<const LikelihoodTable>;

json random_sequences(const LikelihoodTable& table, core::Rng& rng) {
  json all = json::array();
  for (int i = 0; i < sequences_of_each; ++i) {
    json sequence = json::array();
    for (std::uint32_t left = 1 + rng.below(24); left > 0; --left) {
      const auto stimulus = rng.below(static_cast<std::uint32_t>(table.stimuli()));
      const auto outcome = rng.below(static_cast<std::uint32_t>(table.design().outcomes));
      sequence.push_back(json::array({table.stimulus(stimulus), outcome}));
    }
    all.push_back(sequence);
  }
  return all;
}

Table table_of(const json& one) {
  json procedure = one["ours"];
  procedure["stop"]["trials"] = 100;
  const json whole{{"quest_plus", procedure}};
  const auto settings = testing::procedure_of(whole.dump());
  return std::make_shared<const LikelihoodTable>(
      dynamic_cast<const protocols::QuestPlusSettings&>(*settings).table());
}

// Answers below a border at `low`, above it, or above a second one, `distance` higher.
Table ordered_categories() {
  protocols::QuestPlusDesign design;
  design.axes = {{-3, -2, -1, 0, 1, 2, 3}};
  design.parameters = {{"low", {-2, -1, 0, 1}, {1, 1, 1, 1}}, {"distance", {0.5, 1, 2}, {1, 1, 1}}};
  design.outcomes = 3;
  design.model = [](auto stimulus, auto parameters, auto probabilities) {
    const auto above = [&](double border) { return 1.0 / (1.0 + std::exp(border - stimulus[0])); };
    const double one = above(parameters[0]);
    const double two = above(parameters[0] + parameters[1]);
    probabilities[0] = 1.0 - one;
    probabilities[1] = one - two;
    probabilities[2] = two;
  };
  return std::make_shared<const LikelihoodTable>(design);
}

void check_estimates(const LikelihoodTable& table, const QuestPlusTrack& track,
                     const json& theirs) {
  const auto ours = track.summary().parameters;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    INFO(ours[i].name);
    CHECK(ours[i].mean == Approx(theirs[i]["mean"].get<double>()).margin(precision));
    CHECK(ours[i].mode == theirs[i]["mode"].get<double>());
    CHECK(ours[i].standard_deviation == Approx(theirs[i]["sd"].get<double>()).margin(1e-8));
    const auto& values = table.design().parameters[i].values;
    for (const auto& [probability, value] : ours[i].quantiles) {
      double below = 0.0;
      std::size_t place = 0;
      for (; values[place] < value; ++place) {
        below += theirs[i]["marginal"][place].get<double>();
      }
      CHECK(below <= probability);
      CHECK(below + theirs[i]["marginal"][place].get<double>() >= probability - precision);
    }
  }
}

void check_same(const Table& table, const json& sequence, const json& theirs) {
  QuestPlusTrack track{table, {100, {}}};
  for (const json& trial : sequence) {
    track.observe(trial[0].get<std::vector<double>>(), trial[1].get<std::size_t>());
  }
  const auto expected = theirs["posterior"].get<std::vector<double>>();
  REQUIRE(track.posterior().size() == expected.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    worst = std::max(worst, std::abs(track.posterior()[i] - expected[i]));
  }
  CHECK(worst < precision);
  if (!theirs["estimates"].empty()) {
    check_estimates(*table, track, theirs["estimates"]);
  }
  const auto entropies = protocols::expected_entropies(*table, track.posterior());
  const double least = *std::ranges::min_element(entropies);
  CHECK(least == Approx(theirs["entropy"].get<double>()).margin(precision));
  const auto chosen = theirs["next"].get<std::vector<double>>();
  if (track.next() != chosen) {
    // then both are as good: rounding, which we disregard, decided theirs
    for (std::size_t i = 0; i < entropies.size(); ++i) {
      const bool is_either = table->stimulus(i) == chosen || table->stimulus(i) == *track.next();
      CHECK((!is_either || entropies[i] <= least + protocols::entropy_tie));
    }
  }
}
}  // namespace

TEST_CASE("posterior and next stimulus of QUEST+ are those of questplus",
          "[protocols][procedures][slow]") {
  json cases = json::parse(testing::contents(testing::source(folder + "questplus_cases.json")));
  std::vector<Table> tables;
  std::ranges::transform(cases, std::back_inserter(tables), table_of);
  cases.push_back(json::parse(
      R"({"name": "three outcomes", "categories": true, "estimates": true, "questplus": {
    "func": "weibull", "stim_scale": "log10", 
    "stim_domain": {"intensity": [-3, -2, -1, 0, 1, 2, 3]},
    "param_domain": {"threshold": [-2, -1, 0, 1], "slope": [0.5, 1, 2]}}})"));
  tables.push_back(ordered_categories());
  core::Rng rng{7};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    cases[i]["sequences"] = random_sequences(*tables[i], rng);
  }
  const auto run = testing::run_program(
      {"/usr/bin/python3", testing::source(folder + "questplus_answers.py")}, cases.dump());
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  const json theirs = json::parse(run.standard_output);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (std::size_t j = 0; j < sequences_of_each; ++j) {
      INFO(cases[i]["name"] << ", sequence " << j << ": " << cases[i]["sequences"][j]);
      check_same(tables[i], cases[i]["sequences"][j], theirs[i][j]);
    }
  }
}

// Who is always right has no threshold within the grid; who is known exactly has one inside it.
TEST_CASE("a mode at the first or last value of its grid is one at its end, rates apart",
          "[protocols][procedures]") {
  const Settings settings = testing::procedure_of(psi);
  const auto ends_after = [&](const auto& answer) {
    const auto track = settings->start(1);
    while (const auto values = track->next()) {
      track->observe(*values, answer(values->front()));
    }
    std::map<std::string, bool> ends;
    for (const auto& posterior : track->summary().parameters) {
      ends[posterior.name] = protocols::is_at_end_of_grid(posterior, *settings);
    }
    return ends;
  };
  const auto always_right = ends_after([](double) { return std::size_t{1}; });
  CHECK(always_right.at("threshold"));
  CHECK_FALSE(always_right.at("guess"));
  CHECK_FALSE(always_right.at("lapse"));
  testing::KnownObserver observer{{core::PsychometricShape::logistic, 0.0, 1.5, 0.5, 0.02}, 5};
  CHECK_FALSE(ends_after([&](double value) { return observer.answer(value); }).at("threshold"));
  const Settings steps = testing::procedure_of(staircase);
  CHECK_FALSE(protocols::is_at_end_of_grid({"threshold", 0.0, -2.0, 0.0, {}}, *steps));
}
