#include "device/hand/scripted_hand.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "device/loop/haptic_loop.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
#include "support/trace_samples.hpp"
using namespace tapstudy;
using core::Vec3;

namespace {
const core::HandBody body;
constexpr double tick_s = 1e-3;

// Held by a hand that moves as it likes.
class HeldDevice final : public device::Device {
 public:
  explicit HeldDevice(double sway_m) : sway_m_{sway_m} {}
  core::TickFault read(core::HandState& hand, double /*elapsed_s*/) noexcept override {
    hand.position_m = {sway_m_ * std::sin(0.01 * reads_++), sway_m_, 0.0};
    hand.velocity_m_s = Vec3::Zero();
    return core::TickFault::none;
  }
  core::TickFault write(const Vec3& force_n) noexcept override {
    written_n.push_back(force_n.y());
    return core::TickFault::none;
  }
  device::DeviceDetail detail() const noexcept override { return {}; }
  std::string description() const override { return "held"; }
  std::vector<double> written_n;

 private:
  double sway_m_;
  int reads_{0};
};

std::vector<core::TapRenderer> two_springs() {
  std::vector<core::TapRenderer> springs;
  for (int i = 0; i < 2; ++i) {
    springs.emplace_back(core::RenderSettings{}, core::PlateFace{0.3, 0.3},
                         std::vector<std::unique_ptr<core::AddedForce>>{});
  }
  return springs;
}

device::LoopSettings strong() {
  device::LoopSettings settings;
  settings.gate.limits = {20.0, 1e6};
  return settings;
}

struct Bench {
  explicit Bench(double sway_m) : held{sway_m} { held.written_n.reserve(20'000); }
  std::vector<core::TraceSample> samples() { return testing::samples_of(trace); }
  HeldDevice held;
  device::VirtualClock clock;
  std::vector<core::TapRenderer> renderers{two_springs()};
  device::LoopSettings settings{strong()};
  core::SpscRing<core::TraceSample> trace{1U << 15U};
  device::ScriptedHand taps{{body, {0.1, 0.0, 0.0}, 0.3, 0.2, 0.3}, {}, tick_s};
  device::HapticLoop loop{held, renderers, settings, trace, clock, &taps};
};

std::vector<std::size_t> impacts(const std::vector<core::TraceSample>& samples) {
  std::vector<std::size_t> ticks;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].impact) {
      ticks.push_back(i);
    }
  }
  return ticks;
}
}  // namespace

TEST_CASE("scripted taps are all alike, at the stated speed and as often as stated",
          "[device][scripted]") {
  Bench bench{0.0};
  const device::RepeatedTap tap{body, {0.1, 0.0, 0.0}, 0.3, 0.2, 0.3};
  const auto period = static_cast<std::size_t>(std::ceil(tap.duration_s() / tick_s));
  bench.loop.run_ticks(static_cast<std::int64_t>(5 * period));
  const auto samples = bench.samples();
  const auto at = impacts(samples);
  REQUIRE(at.size() >= 5);  // a hand may bounce
  for (std::size_t tick = 0; tick < period; ++tick) {
    for (std::size_t k = 1; k < 5; ++k) {
      REQUIRE(samples[tick + k * period].penalty_n == samples[tick].penalty_n);
      REQUIRE(samples[tick + k * period].position_m == samples[tick].position_m);
    }
  }
  CHECK(-samples[at.front()].velocity_m_s[1] == Approx(0.3).epsilon(0.02));
}

TEST_CASE("what the held hand does changes neither a scripted tap nor the force that it feels",
          "[device][scripted]") {
  Bench still{0.0};
  Bench swaying{0.02};
  still.loop.run_ticks(2000);
  swaying.loop.run_ticks(2000);
  CHECK(still.held.written_n == swaying.held.written_n);
  const auto felt = still.samples();
  REQUIRE(impacts(felt).size() >= 2);
  for (std::size_t i = 0; i < felt.size(); ++i) {
    REQUIRE(still.held.written_n[i] == felt[i].force_n[1]);
    REQUIRE(felt[i].force_n[1] == Approx(felt[i].penalty_n));
  }
}

TEST_CASE("after a switch and after silence the first scripted tap comes as soon as at the begin",
          "[device][scripted]") {
  Bench bench{0.0};
  bench.loop.run_ticks(1000);
  const std::size_t first = impacts(bench.samples()).front();
  bench.loop.request_alternative(1);
  bench.loop.run_ticks(1000);
  const auto switched = bench.samples();
  const auto by_second = std::ranges::find(switched, 1, &core::TraceSample::alternative);
  REQUIRE(by_second != switched.end());
  const auto taken = static_cast<std::size_t>(by_second - switched.begin());
  CHECK(impacts({by_second, switched.end()}).front() == first);
  CHECK(taken < 1000);
  bench.loop.request_silence(true);
  bench.loop.run_ticks(1000);
  bench.samples();
  bench.loop.request_silence(false);
  bench.loop.run_ticks(1000);
  // it may have been asked for in contact, which nobody felt
  const auto again = impacts(bench.samples());
  REQUIRE_FALSE(again.empty());
  CHECK(again.front() >= first);
  CHECK(again.front() < first + 300);
}

TEST_CASE("a hand that leaves the workspace ends scripted taps as it ends its own",
          "[device][scripted][safety]") {
  Bench bench{0.02};
  bench.settings.gate.workspace_radius_m = 0.01;
  device::ScriptedHand taps{{body, Vec3::Zero(), 0.3, 0.2, 0.3}, {}, tick_s};
  device::HapticLoop loop{bench.held,  bench.renderers, bench.settings,
                          bench.trace, bench.clock,     &taps};
  loop.run_ticks(10);
  CHECK(loop.report().stopped_by == core::TickFault::outside_workspace);
  CHECK(bench.held.written_n.back() == 0.0);
}

TEST_CASE("a tick of scripted taps allocates nothing", "[device][scripted]") {
  Bench bench{0.0};
  const testing::AllocationCount allocations;
  bench.loop.run_ticks(2000);
  CHECK(allocations.count() == 0);
}
