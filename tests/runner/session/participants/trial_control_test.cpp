// What a participant and an operator can do in a trial.
#include "runner/session/participants/trial_control.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "protocols/reader/read_protocol.hpp"
#include "protocols/schedule/schedule.hpp"
#include "runner/session/participants/terminal_trial.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
class Positions final : public runner::Exploration {
 public:
  void request_position(std::size_t position) override { current_ = position; }
  void request_silence(bool /*is_silent*/) override {}
  bool is_as_requested() const override { return true; }
  std::size_t current() const { return current_; }
  void pass_time(double seconds) override { time_s_ += seconds; }
  bool is_running() const override { return true; }
  bool is_rendering() const override { return true; }
  double time_s() const override { return time_s_; }
  int contacts(std::size_t position) const override { return contacts_.at(position); }
  std::map<std::size_t, int> contacts_;

 private:
  std::size_t current_{0};
  double time_s_{0.0};
};

struct Planned {
  protocols::Protocol protocol{
      protocols::read_protocol(testing::source("tests/data/every_task.yaml"))};
  const protocols::Block& block{protocol.block("adjustment")};
  protocols::PlannedTrial trial() const {
    for (const protocols::PlannedTrial& one : make_schedule(protocol, 5, 0)) {
      if (one.block == block.name) {
        return one;
      }
    }
    return {};
  }
};
}  // namespace

TEST_CASE("every setting has a position behind the standard, at its value of the axis",
          "[runner][session]") {
  const Planned planned;
  const protocols::PlannedTrial trial = planned.trial();
  const auto all = rendered(trial, planned.block);
  const std::vector<double>& values = planned.block.adjustment->values;
  REQUIRE(all.size() == 1 + values.size());
  CHECK(all.front().values == trial.alternatives.front().values);
  CHECK_FALSE(all.front().is_comparison);
  for (std::size_t i = 0; i < values.size(); ++i) {
    CHECK(all[1 + i].values.at("sinusoid_amplitude_n_s_per_m") == values[i]);
    CHECK(all[1 + i].is_comparison);
  }
}

TEST_CASE("a setting is rendered at once, felt by itself, and an event with its value and time",
          "[runner][session]") {
  const Planned planned;
  const protocols::PlannedTrial trial = planned.trial();
  const std::vector<double>& values = planned.block.adjustment->values;
  const double start = trial.alternatives.back().values.at("sinusoid_amplitude_n_s_per_m");
  Positions positions;
  positions.contacts_ = {{0, 5}, {3, 7}, {11, 0}};
  runner::TrialEvents events;
  runner::TrialControl adjusted{positions, runner::rules_of(trial, planned.block), events};
  CHECK(values.at(adjusted.setting()) == start);
  adjusted.switch_to(1);
  CHECK(positions.current() == 1 + adjusted.setting());
  CHECK(adjusted.current() == 1);
  adjusted.pass_time(2.0);
  adjusted.adjust(2);
  CHECK(positions.current() == 3);
  CHECK(adjusted.contacts(1) == 7);
  adjusted.switch_to(0);
  CHECK(adjusted.current() == 0);
  CHECK(adjusted.contacts(0) == 5);
  adjusted.pass_time(1.0);
  adjusted.adjust(10);
  CHECK(adjusted.current() == 1);
  CHECK(adjusted.contacts(1) == 0);
  adjusted.adjust(values.size());  // there is none
  CHECK(adjusted.setting() == 10);
  adjusted.adjust(10);  // it is so
  adjusted.adjust(9);
  adjusted.adjust(10);  // within the same tick
  REQUIRE(events.rows().size() == 5);
  const std::vector<double> expected{start, values[2], values[10], values[9], values[10]};
  const std::vector<double> times_s{0.0, 2.0, 3.0, 3.0, 3.0};
  for (std::size_t i = 0; i < events.rows().size(); ++i) {
    CHECK(events.rows()[i].kind == "setting");
    CHECK(events.rows()[i].value == expected[i]);
    CHECK(events.rows()[i].t_s == times_s[i]);
  }
}

TEST_CASE("alternatives without settings keep their positions", "[runner][session]") {
  const Planned planned;
  for (const protocols::PlannedTrial& trial : make_schedule(planned.protocol, 5, 0)) {
    if (trial.block == planned.block.name) {
      continue;
    }
    Positions positions;
    runner::TrialEvents events;
    runner::TrialControl same{positions,
                              runner::rules_of(trial, planned.protocol.block(trial.block)), events};
    for (std::size_t i = 0; i < trial.alternatives.size(); ++i) {
      positions.contacts_[i] = 10 + static_cast<int>(i);
      same.switch_to(i);
      CHECK(positions.current() == i);
      CHECK(same.current() == i);
      CHECK(same.contacts(i) == 10 + static_cast<int>(i));
      same.adjust(0);
      CHECK(positions.current() == i);
    }
    CHECK(events.rows().empty());
  }
}

// Alternatives that come one after the other.
using Phase = runner::IntervalState::Phase;

namespace {
// Ticks of a millisecond; taps as often as it is told what is not silent.
class World final : public runner::Exploration {
 public:
  void request_position(std::size_t position) override { current_ = position; }
  std::size_t current() const { return current_; }
  void request_silence(bool is_silent) override { is_silent_ = is_silent; }
  void pass_time(double seconds) override {
    const std::int64_t passed = std::llround(seconds * 1000.0);
    ticks_ += passed;
    contacts_[current_] += !is_silent_ && taps ? static_cast<int>(passed) : 0;
  }
  bool is_running() const override { return true; }
  bool is_rendering() const override { return true; }
  double time_s() const override { return 1e-3 * static_cast<double>(ticks_); }
  int contacts(std::size_t position) const override {
    return contacts_.contains(position) ? contacts_.at(position) : 0;
  }
  bool is_silent() const { return is_silent_; }
  bool is_as_requested() const override { return !presses; }
  bool taps{true};
  bool presses{false};  // the finger stays on the plate, so that nothing changes

 private:
  std::int64_t ticks_{0};
  std::size_t current_{0};
  bool is_silent_{false};
  std::map<std::size_t, int> contacts_;
};

protocols::ExploreLimits limits_with(int replays) {
  protocols::ExploreLimits limits;
  limits.intervals = protocols::Intervals{1.0, 0.5, replays};
  return limits;
}
}  // namespace

TEST_CASE("alternatives come in their order, each for its time, with silence around each",
          "[runner][session]") {
  World world;
  const protocols::ExploreLimits limits = limits_with(0);
  runner::TrialEvents events;
  runner::TrialControl in_turn{world, {limits, 3}, events};
  for (int i = 0; i < 6000; ++i) {
    in_turn.switch_to(2);  // nobody switches
    in_turn.pass_time(0.001);
    const bool is_open = in_turn.intervals()->phase == Phase::open;
    REQUIRE(world.is_silent() != is_open);
  }
  REQUIRE(events.rows().size() == 6);
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(events.rows()[i].kind == (i % 2 == 0 ? "interval" : "interval_end"));
    CHECK(events.rows()[i].value == static_cast<double>(i / 2));
    CHECK(events.rows()[i].t_s ==
          Approx(0.5 + 1.5 * static_cast<double>(i / 2) + 1.0 * static_cast<double>(i % 2))
              .margin(0.02));
  }
  CHECK(in_turn.intervals()->phase == Phase::over);
  for (std::size_t alternative = 0; alternative < 3; ++alternative) {
    CHECK(world.contacts(alternative) == Approx(1000).margin(20));
  }
}

TEST_CASE("however long the participant lets pass at once, intervals begin and end in time",
          "[runner][session]") {
  World world;
  const protocols::ExploreLimits limits = limits_with(0);
  runner::TrialEvents events;
  runner::TrialControl in_turn{world, {limits, 2}, events};
  in_turn.pass_time(10.0);
  CHECK(in_turn.time_s() == Approx(10.0));
  REQUIRE(events.rows().size() == 4);
  CHECK(events.rows()[3].t_s == Approx(3.0).margin(0.05));
  in_turn.pass_time(0.0004);  // less than a tick
  CHECK(in_turn.time_s() == Approx(10.0));
}

TEST_CASE("an interval lasts until it was tapped, and only then an answer is taken",
          "[runner][session]") {
  World world;
  world.taps = false;
  protocols::Block block;
  block.explore = limits_with(0);
  runner::TrialPrompt prompt;
  prompt.block = &block;
  prompt.alternative_labels = {"A", "B"};
  runner::TrialEvents events;
  runner::TrialControl in_turn{world, {block.explore, 2}, events};
  in_turn.pass_time(20.0);
  CHECK(in_turn.intervals()->phase == Phase::open);
  CHECK(in_turn.current() == 0);
  REQUIRE(too_early(prompt, "A", in_turn.explored()).has_value());
  CHECK(too_early(prompt, "A", in_turn.explored())->reason == runner::TooEarly::Reason::intervals);
  world.taps = true;
  in_turn.pass_time(5.0);
  CHECK(in_turn.intervals()->phase == Phase::over);
  CHECK_FALSE(too_early(prompt, "A", in_turn.explored()).has_value());
}

TEST_CASE("an interval begins, and its time counts, once its alternative is felt",
          "[runner][session]") {
  World world;
  const protocols::ExploreLimits limits = limits_with(0);
  runner::TrialEvents events;
  runner::TrialControl in_turn{world, {limits, 2}, events};
  in_turn.pass_time(1.0);
  world.presses = true;  // from within the first interval until long after its end
  in_turn.pass_time(2.0);
  CHECK(in_turn.intervals()->phase == Phase::leaving);
  REQUIRE(events.rows().size() == 2);
  world.presses = false;
  in_turn.pass_time(5.0);
  REQUIRE(events.rows().size() == 4);
  CHECK(events.rows()[2].t_s == Approx(3.5).margin(0.03));  // the gap is whole
  CHECK(events.rows()[3].t_s == Approx(4.5).margin(0.05));
}

TEST_CASE("all intervals come again as often as the protocol allows, and only when they are over",
          "[runner][session]") {
  World world;
  const protocols::ExploreLimits limits = limits_with(2);
  runner::TrialEvents events;
  runner::TrialControl in_turn{world, {limits, 2}, events};
  in_turn.replay();
  CHECK(in_turn.intervals()->replays_left == 2);
  for (const int left : {1, 0, 0}) {
    in_turn.pass_time(5.0);
    REQUIRE(in_turn.intervals()->phase == Phase::over);
    in_turn.replay();
    CHECK(in_turn.intervals()->replays_left == left);
  }
  CHECK(std::ranges::count(events.rows(), "interval", &results::EventRow::kind) == 6);
  CHECK(std::ranges::count(events.rows(), "interval_replay", &results::EventRow::kind) == 2);
}

TEST_CASE("without intervals alternatives are switched freely", "[runner][session]") {
  World world;
  const protocols::ExploreLimits limits;
  runner::TrialEvents events;
  runner::TrialControl free{world, {limits, 2}, events};
  free.pass_time(3.0);
  free.switch_to(1);
  CHECK(world.current() == 1);
  CHECK_FALSE(world.is_silent());
  CHECK(free.intervals() == nullptr);
  CHECK(events.rows().empty());
}

// Rules by themselves.
TEST_CASE("no more time passes in a trial than its limit leaves", "[runner][session]") {
  runner::TrialRules rules;
  CHECK(rules.seconds_left_of(3.0, 100.0) == 3.0);
  CHECK_FALSE(rules.is_time_over(1e9));
  rules.limits.max_seconds = 5.0;
  CHECK(rules.seconds_left_of(3.0, 1.0) == 3.0);
  CHECK(rules.seconds_left_of(3.0, 4.0) == 1.0);
  CHECK(rules.seconds_left_of(3.0, 7.0) == 0.0);
  CHECK_FALSE(rules.is_time_over(4.999));
  CHECK(rules.is_time_over(5.0));
}

TEST_CASE("the operator ends a trial by the request that came first, and switches where one can",
          "[runner][session][operator]") {
  Positions positions;
  runner::TrialEvents events;
  runner::OperatorRequests wanted;
  std::vector<std::size_t> told;
  runner::TrialControl control{
      positions,
      {{}, 3},
      events,
      {[&] { return std::exchange(wanted, {}); }, [&](std::size_t i) { told.push_back(i); }}};
  wanted.switch_to = 2;
  CHECK(control.poll());
  CHECK(positions.current() == 2);
  CHECK(told == std::vector<std::size_t>{2});
  wanted.end = runner::TrialRequest::skip;
  CHECK_FALSE(control.poll());
  wanted.is_paused = true;
  CHECK_FALSE(control.poll());
  REQUIRE(control.ended_by_operator());
  CHECK(control.ended_by_operator()->end == runner::TrialRequest::skip);
  CHECK_FALSE(control.ended_by_operator()->is_paused);
}

TEST_CASE("an answer that is entered twice is told once, and its withdrawal too",
          "[runner][session]") {
  Positions positions;
  runner::TrialEvents events;
  std::vector<std::string> told;
  runner::TrialControl control{
      positions, {}, events, {{}, {}, [&](const std::string& answer) { told.push_back(answer); }}};
  for (const char* const answer : {"", "A", "A", "B", "", ""}) {
    control.enter_answer(answer);
  }
  CHECK(told == std::vector<std::string>{"A", "B", ""});
}

TEST_CASE("the time that is left is told at the terminal at 30, 10 and 5 s, each once",
          "[runner][session]") {
  const auto told = [](std::optional<double> limit_s, const std::vector<double>& times) {
    runner::TypedCountdown countdown{limit_s};
    std::vector<int> seconds;
    for (const double time_s : times) {
      seconds.push_back(countdown.due(time_s).value_or(0));
    }
    return seconds;
  };
  CHECK(told(40.0, {0.0, 9.9, 10.0, 10.1, 29.0, 30.0, 34.0, 36.0, 39.0}) ==
        std::vector{0, 0, 30, 0, 0, 10, 0, 5, 0});
  CHECK(told(10.0, {0.0, 1.0, 5.0}) == std::vector{0, 0, 5});  // its begin says 10
  CHECK(told(60.0, {0.0, 56.0, 57.0}) == std::vector{0, 5, 0});
  CHECK(told({}, {0.0, 1e6}) == std::vector{0, 0});
}
