#include "runner/console/live_view.hpp"

#include "core/placement.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
using runner::LiveView;

namespace {
// One tick of a millisecond: pressed into the plate with so much force.
core::TraceSample tick(std::int64_t number, double force_n, double height_m) {
  core::TraceSample sample{};
  sample.t_ns = number * 1'000'000;
  sample.position_m = {0.0, height_m, 0.0};
  sample.force_n = {0.0, force_n, 0.0};
  sample.touching = height_m < 0.0;
  return sample;
}
}  // namespace

TEST_CASE("a screen's step has the largest force and the lowest position of its ticks",
          "[runner][console]") {
  LiveView live;
  live.begin_trial();
  for (int i = 0; i < 25; ++i) {
    live.add(tick(i, i == 5 ? 3.0 : 1.0, i == 15 ? -0.002 : 0.01));
  }
  const LiveView::Steps steps = live.since(-1);
  REQUIRE(steps.steps.size() == 2);  // the third is not over
  CHECK(steps.steps[0].force_n == 3.0);
  CHECK(core::along_normal(steps.steps[0].lowest_m) == 0.01);
  CHECK(steps.steps[1].force_n == 1.0);
  CHECK(core::along_normal(steps.steps[1].lowest_m) == -0.002);
  CHECK(live.since(steps.end).steps.empty());
  CHECK(live.totals().contacts == 1);
  CHECK(live.totals().ticks == 25);
  live.begin_trial();
  CHECK(live.totals().contacts == 0);
}

TEST_CASE("a late tick is seen in the longest interval of its step, a pause between trials in none",
          "[runner][console]") {
  LiveView live;
  live.begin_trial();
  constexpr std::int64_t late_ns = 700'000;
  for (int i = 0; i < 25; ++i) {
    core::TraceSample sample = tick(i, 0.0, 0.01);
    sample.t_ns += i == 15 ? late_ns : 0;
    live.add(sample);
  }
  live.begin_trial();
  for (int i = 1000; i < 1025; ++i) {
    live.add(tick(i, 0.0, 0.01));
  }
  const auto steps = live.since(-1).steps;
  REQUIRE(steps.size() == 4);
  CHECK(steps[0].interval_s == Approx(0.001));
  CHECK(steps[1].interval_s == Approx(0.0017));
  CHECK(steps[2].interval_s == Approx(0.001));
}

TEST_CASE("a page that was away for long gets the latest steps, as many as are kept",
          "[runner][console]") {
  LiveView live;
  live.begin_trial();
  for (int i = 0; i < 100'000; ++i) {
    live.add(tick(i, i, 0.01));
  }
  const LiveView::Steps steps = live.since(3);
  CHECK(steps.steps.size() == 600);
  CHECK(steps.steps.back().force_n == 99'989.0);
}

TEST_CASE("a tick with a fault moves no pointer", "[runner][console]") {
  LiveView live;
  live.add(tick(0, 0.0, 0.01));
  core::TraceSample faulty = tick(1, 0.0, std::nan(""));
  faulty.fault = core::TickFault::device_gone;
  live.add(faulty);
  CHECK(live.pointer().position_m.y() == 0.01);
}
