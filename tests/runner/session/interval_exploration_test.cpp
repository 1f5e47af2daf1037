// Alternatives that come one after the other.
#include "runner/session/interval_exploration.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "runner/participants/participant.hpp"
#include "runner/session/explore_limits.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
using Phase = runner::IntervalState::Phase;

namespace {
// Ticks of a millisecond; taps as often as it is told what is not silent.
class World final : public runner::Exploration {
 public:
  void switch_to(std::size_t alternative) override { current_ = alternative; }
  std::size_t current() const override { return current_; }
  void silence(bool is_silent) override { is_silent_ = is_silent; }
  void pass_time(double seconds) override {
    const std::int64_t passed = std::llround(seconds * 1000.0);
    ticks_ += passed;
    contacts_[current_] += !is_silent_ && taps ? static_cast<int>(passed) : 0;
  }
  bool is_running() const override { return true; }
  double time_s() const override { return 1e-3 * static_cast<double>(ticks_); }
  int contacts(std::size_t alternative) const override {
    return contacts_.contains(alternative) ? contacts_.at(alternative) : 0;
  }
  bool is_silent() const { return is_silent_; }
  bool is_as_asked() const override { return !presses; }
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
  runner::IntervalExploration in_turn{world, limits, 3, events};
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
  runner::IntervalExploration in_turn{world, limits, 2, events};
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
  runner::IntervalExploration in_turn{world, block.explore, 2, events};
  in_turn.pass_time(20.0);
  CHECK(in_turn.intervals()->phase == Phase::open);
  CHECK(in_turn.current() == 0);
  REQUIRE(too_early(prompt, "A", in_turn).has_value());
  CHECK(too_early(prompt, "A", in_turn)->reason == runner::TooEarly::Reason::intervals);
  world.taps = true;
  in_turn.pass_time(5.0);
  CHECK(in_turn.intervals()->phase == Phase::over);
  CHECK_FALSE(too_early(prompt, "A", in_turn).has_value());
}

TEST_CASE("an interval begins, and its time counts, once its alternative is felt",
          "[runner][session]") {
  World world;
  const protocols::ExploreLimits limits = limits_with(0);
  runner::TrialEvents events;
  runner::IntervalExploration in_turn{world, limits, 2, events};
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
  runner::IntervalExploration in_turn{world, limits, 2, events};
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

TEST_CASE("without intervals an exploration is as free as it was", "[runner][session]") {
  World world;
  const protocols::ExploreLimits limits;
  runner::TrialEvents events;
  runner::IntervalExploration free{world, limits, 2, events};
  free.pass_time(3.0);
  free.switch_to(1);
  CHECK(world.current() == 1);
  CHECK_FALSE(world.is_silent());
  CHECK(free.intervals() == nullptr);
  CHECK(events.rows().empty());
}
