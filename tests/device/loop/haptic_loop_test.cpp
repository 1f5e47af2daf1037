#include "device/loop/haptic_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/random/rng.hpp"
#include "device/loop/tick_clock.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
#include "support/staged_loop.hpp"
using namespace tapstudy;
using core::Vec3;

namespace {
// In a plate 2 mm deep from the second reading on; fails on cue.
class FakeDevice : public device::Device {
 public:
  core::TickFault read(core::HandState& hand, double seconds) noexcept override {
    hand.position_m = {0.0, ++reads_ == 1 ? 0.01 : height_m, 0.0};
    hand.velocity_m_s = {0.0, speed_m_s, 0.0};
    elapsed_s = seconds;
    return reads_ == fail_read_at ? core::TickFault::no_reply : core::TickFault::none;
  }
  core::TickFault write(const Vec3& force_n) noexcept override {
    last_force_n = force_n;
    ++writes_;
    return writes_ == fail_write_at ? core::TickFault::device_gone : core::TickFault::none;
  }
  device::DeviceDetail detail() const noexcept override {
    device::DeviceDetail detail{last_force_n};
    detail.missed_replies = missed_replies;
    detail.unanswered_s = unanswered_s;
    return detail;
  }
  core::TickFault begin() noexcept override { return fault_at_begin; }
  device::StopOutcome zero_force() noexcept override {
    last_force_n = Vec3::Zero();
    return stop;
  }
  device::StopOutcome emergency_stop() noexcept override {
    last_force_n = Vec3::Zero();
    ++emergency_stops;
    return device::StopOutcome::confirmed;
  }
  std::string description() const override { return "fake"; }

  int emergency_stops{0};
  int missed_replies{0};
  double unanswered_s{0.0};
  double elapsed_s{0.0};
  core::TickFault fault_at_begin{core::TickFault::none};
  device::StopOutcome stop{device::StopOutcome::confirmed};
  double height_m{-0.002};
  double speed_m_s{0.0};
  int fail_read_at{-1};
  int fail_write_at{-1};
  Vec3 last_force_n{Vec3::Zero()};

 private:
  int reads_{0};
  int writes_{0};
};

// Replies in its own time, during which the loop's clock goes on.
class BusyClock final : public device::TickClock {
 public:
  device::Nanoseconds now() noexcept override { return now_; }
  device::Nanoseconds wait_until(device::Nanoseconds deadline) noexcept override {
    return now_ = std::max(now_, deadline);
  }
  void pass(device::Nanoseconds time) noexcept { now_ += time; }

 private:
  device::Nanoseconds now_{0};
};

struct SlowDevice final : FakeDevice {
  core::TickFault read(core::HandState& hand, double seconds) noexcept override {
    clock.pass(reply);
    return FakeDevice::read(hand, seconds);
  }
  BusyClock clock;
  device::Nanoseconds reply{0};
};

// Wakes as late as it is told.
class CrankedClock final : public device::TickClock {
 public:
  device::Nanoseconds now() noexcept override { return now_; }
  device::Nanoseconds wait_until(device::Nanoseconds deadline) noexcept override {
    now_ = deadline + (waits_ < lateness.size() ? lateness[waits_] : 0);
    ++waits_;
    return now_;
  }
  device::Nanoseconds suspended() noexcept override { return slept; }
  std::vector<device::Nanoseconds> lateness;
  device::Nanoseconds slept{0};

 private:
  std::size_t waits_{0};
  device::Nanoseconds now_{0};
};

struct Bench {
  explicit Bench(std::size_t ring = 4096) : trace{ring} {
    settings.gate.limits = {10.0, 1e5};
    for (int i = 0; i < 2; ++i) {
      renderers.emplace_back(core::RenderSettings{}, core::PlateFace{0.3, 0.3},
                             std::vector<std::unique_ptr<core::AddedForce>>{});
    }
  }
  std::vector<core::TraceSample> samples() { return testing::samples_of(trace); }
  device::HapticLoop loop() { return {hand, renderers, settings, trace, clock}; }
  FakeDevice hand;
  CrankedClock clock;
  std::vector<core::TapRenderer> renderers;
  device::LoopSettings settings;
  core::SpscRing<core::TraceSample> trace;
};

// Of the force as the device holds it from tick to tick, by its first and last rise through zero,
// each halfway between two ticks.
double frequency_of(std::span<const core::TraceSample> samples) {
  std::vector<double> rises_s;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const auto& [before, now] = std::pair{samples[i - 1], samples[i]};
    if (before.sinusoid_n < -1e-6 && now.sinusoid_n >= -1e-6) {
      const double share = before.sinusoid_n / (before.sinusoid_n - now.sinusoid_n);
      rises_s.push_back(1e-9 * (static_cast<double>(before.t_ns) +
                                share * static_cast<double>(now.t_ns - before.t_ns)));
    }
  }
  return rises_s.size() < 2
             ? 0.0
             : static_cast<double>(rises_s.size() - 1) / (rises_s.back() - rises_s.front());
}

void stop(device::HapticLoop& loop) {
  std::stop_source source;
  source.request_stop();
  loop.run(source.get_token());
}
}  // namespace

TEST_CASE("the loop pushes back on a finger inside the plate", "[device][loop]") {
  Bench bench;
  device::HapticLoop loop = bench.loop();
  loop.run_ticks(10);
  const auto samples = bench.samples();
  REQUIRE(samples.size() == 10);
  CHECK(samples.front().force_n[1] == 0.0);
  CHECK(samples.back().force_n[1] == Approx(3000.0 * 0.002));
  CHECK(samples.back().t_ns == 9'000'000);
  CHECK(loop.report().ticks == 10);
}

TEST_CASE("the loop ends at zero force, whatever ended it", "[device][loop][safety]") {
  Bench bench;
  core::TickFault fault = core::TickFault::none;
  SECTION("asked to stop") {
    device::HapticLoop loop = bench.loop();
    loop.run_ticks(5);
    std::stop_source stop;
    stop.request_stop();
    loop.run(stop.get_token());
    fault = loop.report().stopped_by;
    CHECK(fault == core::TickFault::none);
  }
  SECTION("the device stopped answering") {
    bench.hand.fail_read_at = 5;
    device::HapticLoop loop = bench.loop();
    loop.run_ticks(100);
    CHECK(loop.report().stopped_by == core::TickFault::no_reply);
    CHECK(loop.report().ticks == 5);
    loop.run_ticks(100);
    CHECK(loop.report().ticks == 5);  // a fault is latched
  }
  SECTION("the device stopped taking forces") {
    bench.hand.fail_write_at = 7;
    device::HapticLoop loop = bench.loop();
    loop.run_ticks(100);
    CHECK(loop.report().stopped_by == core::TickFault::device_gone);
  }
  SECTION("the position was not a number") {
    bench.hand.height_m = std::numeric_limits<double>::quiet_NaN();
    device::HapticLoop loop = bench.loop();
    loop.run_ticks(100);
    CHECK(loop.report().stopped_by == core::TickFault::non_finite_force);
  }
  SECTION("the velocity was not a number") {
    bench.hand.speed_m_s = std::numeric_limits<double>::quiet_NaN();
    device::HapticLoop loop = bench.loop();
    loop.run_ticks(100);
    CHECK(loop.report().stopped_by == core::TickFault::non_finite_force);
  }
  CHECK(bench.hand.last_force_n == Vec3::Zero());
}

TEST_CASE(
    "a fault of the actuator is one of the loop, and only a loop in order tells it of its end",
    "[device][loop][actuator][safety]") {
  Bench bench;
  device::HapticLoop loop = bench.loop();
  core::SpscRing<core::ActuatorTick> told{64};
  std::atomic<core::TickFault> fault{core::TickFault::none};
  loop.use({&told, &fault});
  loop.run_ticks(5);
  const bool has_failed = GENERATE(false, true);
  fault = has_failed ? core::TickFault::actuator_gaps : core::TickFault::none;
  std::stop_source stop;
  if (has_failed) {
    loop.run_ticks(1);
    CHECK(bench.hand.last_force_n == Vec3::Zero());
    CHECK(bench.hand.emergency_stops == 1);
  }
  stop.request_stop();
  loop.run(stop.get_token());
  CHECK(loop.report().stopped_by == fault);
  std::vector<core::ActuatorTick> ticks(1);
  while (told.try_pop(ticks.back())) {
    ticks.push_back({});
  }
  ticks.pop_back();
  REQUIRE(ticks.size() >= 5);
  CHECK(ticks.back().is_last == !has_failed);
  CHECK(
      std::ranges::none_of(std::span{ticks}.first(ticks.size() - 1), &core::ActuatorTick::is_last));
  CHECK(ticks.back().at_ns - ticks.at(ticks.size() - 2).at_ns == 1'000'000);
}

TEST_CASE("a tick with a fault is stored with what was read, not with zeros", "[device][loop]") {
  Bench bench;
  SECTION("the hand left the workspace") {
    bench.settings.gate.workspace_radius_m = 0.005;
    bench.hand.height_m = -0.006;
    device::HapticLoop loop = bench.loop();
    loop.run_ticks(1);
    REQUIRE(loop.report().stopped_by == core::TickFault::outside_workspace);
    CHECK(bench.samples().back().position_m[1] == 0.01);
  }
  SECTION("the reading itself failed, after the device had told a position") {
    bench.hand.fail_read_at = 3;
    device::HapticLoop loop = bench.loop();
    loop.run_ticks(10);
    CHECK(bench.samples().back().position_m[1] == bench.hand.height_m);
  }
  SECTION("nothing was read, for the tick came too late") {
    bench.settings.max_late_in_a_row = 1;
    bench.clock.lateness = {0, 600'000, 600'000, 600'000};
    device::HapticLoop loop = bench.loop();
    loop.run_ticks(10);
    REQUIRE(loop.report().stopped_by == core::TickFault::too_late);
    const core::TraceSample unread = bench.samples().back();
    CHECK(std::isnan(unread.position_m[1]));
    CHECK(std::isnan(unread.achieved_n[1]));
  }
}

TEST_CASE("late ticks are counted, missed ones skipped, and the rhythm stays", "[device][loop]") {
  Bench bench;
  bench.clock.lateness = {0, 600'000, 0, 3'200'000, 0};
  device::HapticLoop loop = bench.loop();
  loop.run_ticks(5);
  std::vector<std::int64_t> times;
  for (const core::TraceSample& sample : bench.samples()) {
    times.push_back(sample.t_ns);
  }
  CHECK(times == std::vector<std::int64_t>{0, 1'600'000, 2'000'000, 6'200'000, 7'000'000});
  CHECK(loop.report().late == 2);
  CHECK(loop.report().skipped == 3);
  CHECK(loop.report().lateness.worst() == 3'200'000);
}

TEST_CASE("a vibration keeps its pitch however late the device replies, or the trial ends for it",
          "[device][loop][safety]") {
  constexpr double frequency_hz = 100.0;
  constexpr double period_s = 1e-3;
  SlowDevice hand;
  hand.speed_m_s = -0.1;
  const auto [reply, is_tolerable] =
      GENERATE(table<device::Nanoseconds, bool>({{500'000, true},
                                                 {1'000'000, true},
                                                 {1'005'000, true},
                                                 {1'050'000, false},
                                                 {1'100'000, false},
                                                 {1'500'000, false},
                                                 {2'700'000, false}}));
  hand.reply = reply;
  core::RenderSettings rendering;
  rendering.sinusoid = {3.0, 2.0, frequency_hz, {}};
  std::vector<core::TapRenderer> renderers;
  renderers.push_back(core::make_renderer(*core::find_technique("sinusoid"), rendering,
                                          core::PlateFace{0.3, 0.3}, nullptr));
  device::LoopSettings settings;
  settings.gate.limits = {10.0, 1e5};
  const bool is_judged = GENERATE(false, true);
  settings.max_missed_share = is_judged ? 0.01 : 1.0;
  core::SpscRing<core::TraceSample> trace{4096};
  device::HapticLoop loop{hand, renderers, settings, trace, hand.clock};
  loop.run_ticks(1500);
  CAPTURE(reply, is_judged);
  const bool has_ended = loop.report().stopped_by == core::TickFault::periods_missed;
  CHECK(has_ended == (is_judged && !is_tolerable));
  const std::vector<core::TraceSample> samples = testing::samples_of(trace);
  const auto periods_at = [](const core::TraceSample& sample) { return sample.t_ns / 1'000'000; };
  const auto impact = std::ranges::find_if(samples, &core::TraceSample::impact);
  REQUIRE(impact != samples.end());
  for (auto sample = impact; sample != samples.end(); ++sample) {
    const double t_s = period_s * static_cast<double>(periods_at(*sample) - periods_at(*impact));
    const double expected_n =
        0.3 * std::exp(-2.0 * t_s) * std::sin(2.0 * M_PI * frequency_hz * t_s);
    if (sample->fault == core::TickFault::none) {
      REQUIRE(sample->sinusoid_n == Approx(expected_n).margin(1e-9));
    }
  }
  const double felt_hz = frequency_of({impact, samples.end()});
  CHECK((has_ended || felt_hz == Approx(frequency_hz).epsilon(0.005)));
  fmt::print("  reply after {:.3f} periods, missed periods {}: {}\n",
             1e-6 * static_cast<double>(reply), is_judged ? "judged " : "allowed",
             has_ended ? core::to_text(loop.report().stopped_by)
                       : fmt::format("{} Hz is felt as {:.2f} Hz", frequency_hz, felt_hz));
}

TEST_CASE("another alternative is taken only off the plate", "[device][loop][safety]") {
  Bench bench;
  device::HapticLoop loop = bench.loop();
  loop.run_ticks(3);
  loop.request_alternative(1);
  loop.run_ticks(3);
  CHECK(bench.samples().back().alternative == 0);  // the finger is still in
  bench.hand.height_m = 0.001;
  loop.run_ticks(2);
  CHECK(bench.samples().back().alternative == 1);
}

TEST_CASE("a switch in the very tick of entry loses neither contact nor impact", "[device][loop]") {
  Bench bench;
  device::HapticLoop loop = bench.loop();
  loop.run_ticks(1);
  loop.request_alternative(1);
  loop.run_ticks(1);
  const core::TraceSample entry = bench.samples().back();
  CHECK(entry.alternative == 1);
  CHECK(entry.touching);
  CHECK(entry.impact);
}

TEST_CASE("silence begins and ends off the plate, and no force begins inside it",
          "[device][loop][safety]") {
  Bench bench;
  device::HapticLoop loop = bench.loop();
  loop.run_ticks(3);
  loop.request_silence(true);
  loop.run_ticks(3);
  CHECK(bench.samples().back().touching);  // the finger is still in
  bench.hand.height_m = 0.001;
  loop.run_ticks(2);
  bench.samples();
  bench.hand.height_m = -0.002;
  loop.run_ticks(3);
  loop.request_silence(false);
  loop.request_alternative(1);
  loop.run_ticks(3);  // the finger is in, but has felt nothing
  for (const core::TraceSample& sample : bench.samples()) {
    CHECK_FALSE(sample.touching);
    CHECK_FALSE(sample.impact);
    CHECK(sample.force_n == std::array<double, 3>{});
    CHECK(sample.alternative == 0);
  }
  CHECK(loop.contacts(0) == 1);
  bench.hand.height_m = 0.001;
  loop.run_ticks(2);
  bench.hand.height_m = -0.002;
  loop.run_ticks(2);
  const core::TraceSample felt = bench.samples().back();
  CHECK(felt.alternative == 1);
  CHECK(felt.force_n[1] > 0.0);
}

TEST_CASE("samples that find no room are counted", "[device][loop]") {
  Bench bench{16};
  device::HapticLoop loop = bench.loop();
  loop.run_ticks(20);
  CHECK(bench.trace.dropped() == 4);
}

TEST_CASE("a thousand ticks of the loop allocate nothing", "[device][loop][realtime]") {
  Bench bench;
  device::HapticLoop loop = bench.loop();
  const testing::AllocationCount allocations;
  loop.run_ticks(1000);
  CHECK(allocations.count() == 0);
}

TEST_CASE("a loop that nobody looks after drops its force within the time allowed",
          "[device][loop][safety]") {
  Bench bench;
  bench.settings.max_heartbeat_gap = 100'000'000;
  device::HapticLoop loop = bench.loop();
  for (int i = 0; i < 10; ++i) {
    loop.beat();
    loop.run_ticks(90);
  }
  CHECK(loop.report().stopped_by == core::TickFault::none);
  loop.run_ticks(90);
  CHECK(loop.report().stopped_by == core::TickFault::heartbeat_lost);
  CHECK(loop.report().ticks <= 900 + 101);
  CHECK(bench.hand.emergency_stops == 1);
  CHECK(bench.hand.last_force_n == Vec3::Zero());
}

TEST_CASE("a loop that stood still itself is a fault, however fast somebody beats when it wakes",
          "[device][loop][safety]") {
  Bench bench;
  bench.settings.max_heartbeat_gap = 100'000'000;
  bench.clock.lateness = std::vector<device::Nanoseconds>(20, 0);
  bench.clock.lateness[10] = 2'000'000'000;
  device::HapticLoop loop = bench.loop();
  for (int i = 0; i < 20; ++i) {
    loop.beat();
    loop.run_ticks(1);
  }
  CHECK(loop.report().stopped_by == core::TickFault::heartbeat_lost);
  CHECK(loop.report().ticks == 11);
  CHECK(bench.hand.last_force_n == Vec3::Zero());
}

TEST_CASE("a run of late ticks is a fault where the rig says so", "[device][loop][safety]") {
  Bench bench;
  bench.clock.lateness = std::vector<device::Nanoseconds>(20, 600'000);
  SECTION("it does") {
    bench.settings.max_late_in_a_row = 5;
    device::HapticLoop loop = bench.loop();
    loop.run_ticks(20);
    CHECK(loop.report().stopped_by == core::TickFault::too_late);
    CHECK(loop.report().ticks == 6);
    CHECK(bench.hand.emergency_stops == 1);
  }
  SECTION("it does not") {
    device::HapticLoop loop = bench.loop();
    loop.run_ticks(20);
    CHECK(loop.report().stopped_by == core::TickFault::none);
    CHECK(loop.report().late == 20);
  }
}

TEST_CASE("asked to stop, the loop lets force fall gently where the rig says so",
          "[device][loop][safety]") {
  Bench bench;
  bench.settings.gate.force_fall_s = 0.1;
  bench.settings.max_heartbeat_gap = 20'000'000;  // nobody beats while it falls
  device::HapticLoop loop = bench.loop();
  loop.run_ticks(10);
  stop(loop);
  const auto samples = bench.samples();
  REQUIRE(samples.size() == Approx(110).margin(2));
  for (std::size_t i = 11; i < samples.size(); ++i) {
    CHECK(samples[i].force_n[1] <= samples[i - 1].force_n[1]);
    CHECK(samples[i - 1].force_n[1] - samples[i].force_n[1] < 0.07);
  }
  CHECK(bench.hand.last_force_n == Vec3::Zero());
}

TEST_CASE("a device is told the time that passed, not the nominal period", "[device][loop]") {
  Bench bench;
  bench.clock.lateness = {0, 0, 2'500'000};
  device::HapticLoop loop = bench.loop();
  loop.run_ticks(2);
  CHECK(bench.hand.elapsed_s == Approx(0.001));
  loop.run_ticks(1);
  CHECK(bench.hand.elapsed_s == Approx(0.0035));
  loop.run_ticks(1);
  CHECK(bench.hand.elapsed_s == Approx(0.0005));  // the rhythm stays
  const auto samples = bench.samples();
  CHECK_FALSE(samples[1].late);
  CHECK(samples[2].late);
}

TEST_CASE(
    "one long stall is a fault where the rig says so, and after a shorter one force rises anew",
    "[device][loop][safety]") {
  Bench bench;
  bench.settings.gate.force_rise_s = 0.1;
  bench.settings.max_stall = 10'000'000;
  bench.hand.height_m = 0.001;
  bench.clock.lateness = std::vector<device::Nanoseconds>(400, 0);
  const device::Nanoseconds stall = GENERATE(1'000'000, 4'000'000, 11'000'000);
  bench.clock.lateness[300] = stall;
  device::HapticLoop loop = bench.loop();
  loop.run_ticks(50);
  bench.hand.height_m = -0.002;
  loop.run_ticks(250);
  REQUIRE(bench.hand.last_force_n.y() == Approx(6.0));
  loop.run_ticks(1);
  CAPTURE(stall);
  CHECK((loop.report().stopped_by == core::TickFault::loop_stalled) == (stall > 9'000'000));
  CHECK((bench.hand.last_force_n.y() < 0.1) == (stall > 3'000'000));
  if (stall == 4'000'000) {
    loop.run_ticks(110);
    CHECK(bench.hand.last_force_n.y() == Approx(6.0));
    const auto samples = bench.samples();
    CHECK_FALSE(samples[299].late);  // the rise at the beginning follows no gap
    CHECK(samples[300].late);
    CHECK(samples[390].late);  // on time, but force is not what the plate's would be
    CHECK_FALSE(samples.back().late);
  }
}

TEST_CASE("a loop that has made no tick for longer than a stall may last is not rendering",
          "[device][loop][safety]") {
  Bench bench;
  bench.settings.max_stall = 10'000'000;
  device::HapticLoop loop = bench.loop();
  loop.run_ticks(10);
  CHECK(loop.is_ticking(bench.clock.now() + 10'000'000));
  CHECK_FALSE(loop.is_ticking(bench.clock.now() + 10'000'001));
  bench.clock.lateness = std::vector<device::Nanoseconds>(11, 20'000'000);
  loop.run_ticks(1);  // found by the loop itself
  CHECK(loop.report().stopped_by == core::TickFault::loop_stalled);
  CHECK_FALSE(loop.is_ticking(bench.clock.now()));
}

TEST_CASE("a machine that slept is a fault", "[device][loop][safety]") {
  Bench bench;
  bench.clock.slept = 7'000'000'000;  // before the trial, which is none
  device::HapticLoop loop = bench.loop();
  loop.run_ticks(10);
  REQUIRE(loop.report().stopped_by == core::TickFault::none);
  bench.clock.slept += 1'000'000'000;
  loop.run_ticks(1);
  CHECK(loop.report().stopped_by == core::TickFault::suspended);
  CHECK(bench.hand.last_force_n == Vec3::Zero());
}

TEST_CASE("while replies are missing force fades, at any rate, to nothing within 10 ms",
          "[device][loop][safety]") {
  Bench bench;
  device::HapticLoop loop = bench.loop();
  loop.run_ticks(5);
  for (const int missed : {1, 2, 5}) {
    bench.hand.missed_replies = missed;
    bench.hand.unanswered_s = 0.002 * missed;
    loop.run_ticks(1);
    CHECK(bench.hand.last_force_n.y() == Approx(6.0 * (5 - missed) / 5.0).margin(1e-12));
    CHECK(bench.samples().back().missed_replies == missed);
  }
  CHECK(loop.report().bridged == 3);
  bench.hand.missed_replies = 0;
  bench.hand.unanswered_s = 0.0;
  loop.run_ticks(1);
  CHECK(bench.hand.last_force_n.y() == Approx(6.0));
}

TEST_CASE("after missing replies force rises again from where it faded to",
          "[device][loop][safety]") {
  Bench bench;
  bench.settings.gate.force_rise_s = 0.1;
  bench.hand.height_m = 0.001;
  device::HapticLoop loop = bench.loop();
  loop.run_ticks(50);
  bench.hand.height_m = -0.002;
  loop.run_ticks(200);
  REQUIRE(bench.hand.last_force_n.y() == Approx(6.0));
  bench.hand.missed_replies = 2;
  bench.hand.unanswered_s = device::max_unanswered_s * 2.0 / 3.0;
  loop.run_ticks(1);
  CHECK(bench.hand.last_force_n.y() == Approx(2.0));
  bench.hand.missed_replies = 0;
  bench.hand.unanswered_s = 0.0;
  loop.run_ticks(10);
  CHECK(bench.hand.last_force_n.y() == Approx(2.0 + 6.0 * 0.1).epsilon(0.01));
  CHECK(bench.samples().back().late);  // an impact would be too weak
  loop.run_ticks(100);
  CHECK(bench.hand.last_force_n.y() == Approx(6.0));
  CHECK_FALSE(bench.samples().back().late);
}

TEST_CASE("a device that cannot begin gets no tick", "[device][loop][safety]") {
  Bench bench;
  bench.hand.fault_at_begin = core::TickFault::guardian_lost;
  device::HapticLoop loop = bench.loop();
  loop.run_ticks(10);
  CHECK(loop.report().stopped_by == core::TickFault::guardian_lost);
  CHECK(loop.report().ticks == 1);
  CHECK(std::isnan(bench.samples().back().position_m[1]));
}

TEST_CASE("a stop that the device does not confirm is a fault", "[device][loop][safety]") {
  Bench bench;
  bench.hand.stop = device::StopOutcome::unconfirmed;
  device::HapticLoop loop = bench.loop();
  stop(loop);
  CHECK(loop.report().stopped_by == core::TickFault::stop_unconfirmed);
  CHECK(loop.report().stop == device::StopOutcome::unconfirmed);
}

TEST_CASE("a soft stop never ends in a step, though the rate limit be slower than the ramp",
          "[device][loop][safety]") {
  Bench bench;
  bench.settings.gate.limits = {10.0, 100.0};  // 6 N take 60 ms
  bench.settings.gate.force_fall_s = 0.01;
  device::HapticLoop loop = bench.loop();
  loop.run_ticks(200);
  stop(loop);
  const auto samples = bench.samples();
  REQUIRE(samples[199].force_n[1] == Approx(6.0));
  for (std::size_t i = 200; i < samples.size(); ++i) {
    CHECK(samples[i - 1].force_n[1] - samples[i].force_n[1] < 0.1 + 1e-9);
  }
  CHECK(samples.back().force_n[1] == 0.0);
}

TEST_CASE("a share of the ticks is told to 2 %, from above", "[device][loop]") {
  core::Rng rng{1};
  device::LatenessCount count;
  std::vector<device::Nanoseconds> all;
  for (int i = 0; i < 20000; ++i) {
    all.push_back(static_cast<device::Nanoseconds>(std::exp(10.0 + 2.0 * rng.normal())));
    count.add(all.back());
  }
  std::ranges::sort(all);
  for (const double share : {0.5, 0.99, 0.999, 1.0}) {
    const auto place = static_cast<std::size_t>(std::ceil(share * 20000.0)) - 1;
    const auto truth = static_cast<double>(all[place]);
    CAPTURE(share, truth);
    CHECK(static_cast<double>(count.quantile(share)) >= truth);
    CHECK(static_cast<double>(count.quantile(share)) <= 1.02 * truth + 1.0);
  }
  CHECK(count.worst() == all.back());
}

TEST_CASE("the interval of a quantile holds that of all ticks in 95 of 100 samples",
          "[device][loop]") {
  constexpr int samples = 1000;
  constexpr int ticks = 4000;
  constexpr double scale_ns = 1e5;
  core::Rng rng{7};
  const double share = GENERATE(0.99, 0.999);
  const double truth_ns = -scale_ns * std::log(1.0 - share);
  int held = 0;
  for (int i = 0; i < samples; ++i) {
    device::LatenessCount count;
    for (int tick = 0; tick < ticks; ++tick) {
      count.add(static_cast<device::Nanoseconds>(-scale_ns * std::log(1.0 - rng.uniform())));
    }
    const auto [low, high] = count.interval_of_quantile(share);
    REQUIRE(high);
    held += static_cast<double>(low) < 1.02 * truth_ns && static_cast<double>(*high) >= truth_ns;
  }
  CHECK(held >= 0.93 * samples);
  CHECK(held <= 0.99 * samples);
}

TEST_CASE(
    "so few ticks that the rarest would not be among them have no upper end of their interval",
    "[device][loop]") {
  device::LatenessCount count;
  CHECK_FALSE(count.interval_of_quantile(0.999).high);
  for (int i = 0; i < 500; ++i) {
    count.add(1000);
  }
  CHECK(count.interval_of_quantile(0.5).high);
  CHECK_FALSE(count.interval_of_quantile(0.999).high);
}

TEST_CASE("nothing late is told as nothing", "[device][loop]") {
  device::LatenessCount count;
  CHECK(count.quantile(0.999) == 0);
  count.add(0);
  count.add(-5);
  CHECK(count.quantile(0.999) == 0);
}
