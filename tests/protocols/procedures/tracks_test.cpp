// What holds of every procedure; constant stimuli; interleaved tracks.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "core/error.hpp"
#include "core/rng.hpp"
#include "protocols/procedures/interleaved_tracks.hpp"
#include "support/catch.hpp"
#include "support/known_observer.hpp"
#include "support/procedures.hpp"
#include "support/processes.hpp"
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
