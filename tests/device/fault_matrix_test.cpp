// What every fault does in every state of the loop, on a simulated SPIDAR behind the real libusb.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <string>
#include <vector>

#include "core/techniques/make_renderer.hpp"
#include "device/loop/haptic_loop.hpp"
#include "support/usb/spidar_on_bus.hpp"
using namespace tapstudy;
using core::TickFault;
using device::ForceGate;
using testing::FakeBus;
using testing::SimulatedSpidar;
using Trouble = FakeBus::Trouble;

namespace {
// Time that passes as told, late from now on if so told.
class SteadyClock final : public device::TickClock {
 public:
  device::Nanoseconds now() noexcept override { return now_; }
  device::Nanoseconds wait_until(device::Nanoseconds deadline) noexcept override {
    return now_ = deadline + lateness;
  }
  device::Nanoseconds lateness{0};

 private:
  device::Nanoseconds now_{0};
};

struct Stage : testing::SpidarOnBus {
  std::vector<core::TapRenderer> renderers;
  core::SpscRing<core::TraceSample> trace{8192};
  SteadyClock clock;
  std::unique_ptr<device::HapticLoop> loop;
  std::stop_source stop;

  Stage() {
    renderers.push_back(core::make_renderer(*core::find_technique("none"), core::RenderSettings{},
                                            core::PlateFace{0.3, 0.3}, nullptr));
    device::LoopSettings settings;
    settings.gate = {{5.0, 5000.0}, 1.0, 0.02, 0.1, 0.1};
    settings.max_late_in_a_row = 5;
    settings.max_heartbeat_gap = 100'000'000;
    loop = std::make_unique<device::HapticLoop>(spidar, renderers, settings, trace, clock);
  }
  void tighten() {
    hardware.hold_at({0.0, 0.005, 0.0});
    for (int step = 1; step <= 500; ++step) {
      REQUIRE(spidar.tighten(step / 500.0) == TickFault::none);
    }
  }
  void home() {
    tighten();
    hardware.hold_at({0.0, 0.0, 0.0});
    for (int step = 0; step < 500; ++step) {
      REQUIRE(spidar.tighten(1.0) == TickFault::none);
    }
    REQUIRE(spidar.home() == TickFault::none);
  }
  void tick(int count) {
    for (int i = 0; i < count; ++i) {
      loop->beat();
      loop->run_ticks(1);
    }
  }
  void arm() {
    home();
    hardware.hold_at({0.0, 0.01, 0.0});
    tick(5);
  }
  void press() {
    arm();
    tick(400);
    hardware.hold_at({0.0, -0.012, 0.0});
    tick(400);
  }
  // The trace's last sample.
  TickFault last_stored() {
    core::TraceSample sample{};
    while (trace.try_pop(sample)) {
    }
    return sample.fault;
  }

  // On from the state reached, until force is off.
  TickFault go_on() {
    tick(200);
    return loop->report().stopped_by;
  }
  TickFault go_on_and_stop() {
    stop.request_stop();
    loop->run(stop.get_token());
    return loop->report().stopped_by;
  }
  TickFault go_on_tightening() {
    TickFault fault = TickFault::none;
    for (int step = 0; step < 200 && fault == TickFault::none; ++step) {
      fault = spidar.tighten(1.0);
    }
    spidar.emergency_stop();
    return fault;
  }
};

struct Fault {
  const char* name;
  std::function<void(Stage&)> happen;
  std::vector<TickFault> seen_as;
  bool is_seen_before_homing{true};  // some need a known position, or the loop
};

std::vector<Fault> all_faults() {
  const auto on_the_wire = [](Trouble trouble, int delay_ms = 0) {
    return [=](Stage& stage) { stage.bus.plan(trouble, 0, std::chrono::milliseconds{delay_ms}); };
  };
  return {
      {"reply 50 ms late", on_the_wire(Trouble::late, 50), {TickFault::no_reply}},
      {"no reply", on_the_wire(Trouble::missing), {TickFault::no_reply}},
      {"half a reply", on_the_wire(Trouble::short_reply), {TickFault::bad_reply}},
      {"stall", on_the_wire(Trouble::stalled), {TickFault::bad_reply}},
      {"protocol error", on_the_wire(Trouble::protocol), {TickFault::bad_reply}},
      {"overflow", on_the_wire(Trouble::overflow), {TickFault::bad_reply}},
      {"kernel out of memory", on_the_wire(Trouble::not_accepted), {TickFault::bad_reply}},
      {"unplugged", [](Stage& stage) { stage.bus.unplug(); }, {TickFault::device_gone}},
      {"unplugged in a tick", on_the_wire(Trouble::unplugged), {TickFault::device_gone}},
      {"wrong echo", [](Stage& stage) { stage.hardware.echo_wrongly(); }, {TickFault::wrong_echo}},
      {"counter jumps",
       [](Stage& stage) { stage.hardware.jump(3, 400); },
       {TickFault::counter_jumped},
       false},
      {"string slips",
       [](Stage& stage) { stage.hardware.jump(3, 100); },
       {TickFault::strings_disagree},
       false},
      {"hand torn away",
       [](Stage& stage) {
         stage.hardware.hold_at({0.3, 0.3, 0.0});
       },
       {TickFault::too_fast, TickFault::outside_workspace, TickFault::counter_jumped},
       false},
      {"ticks late",
       [](Stage& stage) { stage.clock.lateness = 700'000; },
       {TickFault::too_late},
       false}};
}

struct State {
  const char* name;
  void (Stage::*reach)();
  TickFault (Stage::*go_on)();
  bool is_in_the_loop;
};

struct Outcome {
  TickFault seen;
  std::int64_t packets_to_detect;
  std::int64_t packets_with_force;  // of these
  bool is_latched;
  std::string stored;
};

Outcome outcome_of(const Fault& fault, const State& state) {
  Stage stage;
  (stage.*state.reach)();
  REQUIRE(stage.loop->report().stopped_by == TickFault::none);
  fault.happen(stage);
  stage.bus.forget_requests();
  const TickFault seen = (stage.*state.go_on)();
  const auto sent = stage.bus.requests();
  const auto with_force = std::ranges::count_if(
      sent, [](const testing::Bytes& request) { return !testing::has_no_force(request); });
  const bool is_reachable = seen != TickFault::device_gone;
  REQUIRE((sent.size() >= 3 || !is_reachable));
  CHECK((!is_reachable || std::all_of(sent.end() - 3, sent.end(), testing::has_no_force)));
  const std::int64_t stopped_at = stage.loop->report().ticks;
  stage.tick(50);
  core::HandState hand;
  const bool is_latched = (!state.is_in_the_loop || stage.loop->report().ticks == stopped_at) &&
                          !stage.spidar.is_homed() &&
                          stage.spidar.read(hand) == TickFault::not_homed;
  const auto detected = static_cast<std::int64_t>(sent.size()) - (is_reachable ? 3 : 0);
  return {seen, detected, with_force, is_latched,
          state.is_in_the_loop ? core::to_text(stage.last_stored()) : "no trial yet: said"};
}

// How many packets with force on left after the fault began, and that it stays off.
void check_and_print(const Fault& fault, const State& state) {
  CAPTURE(fault.name, state.name);
  const Outcome outcome = outcome_of(fault, state);
  fmt::print("  {:<22}{:<12}{:>6}{:>12}{:>9}    {}\n", fault.name, state.name,
             outcome.packets_to_detect, outcome.packets_with_force,
             outcome.is_latched ? "yes" : "no", outcome.stored);
  CAPTURE(core::to_text(outcome.seen));
  CHECK(std::ranges::count(fault.seen_as, outcome.seen) == 1);
  CHECK((!state.is_in_the_loop || outcome.stored == core::to_text(outcome.seen)));
  CHECK(outcome.is_latched);
  // none after the tick that found it
  CHECK(outcome.packets_with_force <= outcome.packets_to_detect);
}
}  // namespace

TEST_CASE("the fault matrix: force is off by the tick that finds the fault, and stays off",
          "[device][safety][usb]") {
  const std::vector<State> states{{"tightening", &Stage::tighten, &Stage::go_on_tightening, false},
                                  {"armed", &Stage::arm, &Stage::go_on, true},
                                  {"rendering", &Stage::press, &Stage::go_on, true},
                                  {"stopping", &Stage::press, &Stage::go_on_and_stop, true}};
  fmt::print(
      "  fault                 state      ticks  with force  latched    the trial is stored "
      "with\n");
  for (const Fault& fault : all_faults()) {
    for (const State& state : states) {
      if (state.is_in_the_loop || fault.is_seen_before_homing) {
        check_and_print(fault, state);
      }
    }
  }
}

TEST_CASE("pressing on a plate through the whole chain gives the plate's force",
          "[device][safety][usb]") {
  Stage stage;
  stage.press();
  core::TraceSample sample{};
  core::TraceSample last{};
  while (stage.trace.try_pop(sample)) {
    last = sample;
  }
  CHECK(last.touching);
  CHECK(last.force_n[1] == Approx(3000.0 * last.penetration_m));
  CHECK(last.achieved_n[1] == Approx(last.force_n[1]).epsilon(1e-4));
  // the muscle aims 12 mm deep and meets a spring of 3000 N/m: k d / (k + K)
  CHECK(last.penetration_m == Approx(400.0 * 0.012 / 3400.0).epsilon(0.05));
  CHECK(last.closure_margin > 0.0);
}
