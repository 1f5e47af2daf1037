// What every fault does in every state of the loop, on a simulated SPIDAR behind the real libusb.
#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/staged_loop.hpp"
#include "support/usb/spidar_on_bus.hpp"
using namespace tapstudy;
using core::TickFault;
using device::ForceGate;
using testing::FakeBus;
using testing::SimulatedSpidar;
using Trouble = FakeBus::Trouble;

namespace {
struct Stage : testing::SpidarOnBus, testing::StagedLoop {
  std::optional<device::StopOutcome> last_stop;  // outside the loop

  explicit Stage(std::uint16_t board_product) : SpidarOnBus{board_product}, StagedLoop{spidar} {}
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
  TickFault go_on_tightening() {
    TickFault fault = TickFault::none;
    for (int step = 0; step < 200 && fault == TickFault::none; ++step) {
      fault = spidar.tighten(1.0);
    }
    last_stop = spidar.emergency_stop();
    return fault;
  }
};

struct Fault {
  const char* name;
  std::function<void(Stage&)> happen;
  std::vector<TickFault> seen_as;
  bool is_seen_before_homing{true};    // some need a known position, or the loop
  bool is_stop_confirmed{true};        // zero force reaches the board and a reply comes back
  bool is_seen_on_simple_board{true};  // it neither echoes nor measures voltages
};

std::vector<Fault> all_faults() {
  const auto on_the_wire = [](Trouble trouble, int delay_ms = 0) {
    return [=](Stage& stage) { stage.bus.plan(trouble, 0, std::chrono::milliseconds{delay_ms}); };
  };
  const auto from_now_on = [](Trouble trouble) {
    return [=](Stage& stage) { stage.bus.persist_in(trouble); };
  };
  constexpr int for_good = 1'000'000;
  return {
      {"no reply any more", from_now_on(Trouble::missing), {TickFault::no_reply}, true, false},
      {"short from now on", from_now_on(Trouble::short_reply), {TickFault::bad_reply}, true, false},
      {"OUT lost from now on", from_now_on(Trouble::out_lost), {TickFault::no_reply}, true, false},
      {"OUT NAKed from now on", from_now_on(Trouble::out_nak), {TickFault::no_reply}, true, false},
      {"OUT halted", [](Stage& stage) { stage.bus.halt_out(1); }, {TickFault::bad_reply}},
      {"OUT halted for good",
       [](Stage& stage) { stage.bus.halt_out(for_good); },
       {TickFault::bad_reply},
       true,
       false},
      {"half a reply", on_the_wire(Trouble::short_reply), {TickFault::bad_reply}},
      {"stall", on_the_wire(Trouble::stalled), {TickFault::bad_reply}},
      {"protocol error", on_the_wire(Trouble::protocol), {TickFault::bad_reply}},
      {"overflow", on_the_wire(Trouble::overflow), {TickFault::bad_reply}},
      {"kernel out of memory", on_the_wire(Trouble::not_accepted), {TickFault::bad_reply}},
      {"unplugged",
       [](Stage& stage) { stage.bus.unplug(); },
       {TickFault::device_gone},
       true,
       false},
      {"unplugged in a tick",
       on_the_wire(Trouble::unplugged),
       {TickFault::device_gone},
       true,
       false},
      {"wrong echo",
       [](Stage& stage) { stage.hardware.echo_wrongly(); },
       {TickFault::wrong_echo},
       true,
       false,
       false},
      {"counter jumps",
       [](Stage& stage) { stage.hardware.jump(3, 400); },
       {TickFault::counter_jumped},
       false},
      {"amplifier off",
       [](Stage& stage) { stage.hardware.switch_amplifier(false); },
       {TickFault::amplifier_off, TickFault::strings_disagree},
       false,
       true,
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
      {"loop stalls for 11 ms",
       [](Stage& stage) { stage.clock.lateness = 11'000'000; },
       {TickFault::loop_stalled},
       false},
      {"machine suspended",
       [](Stage& stage) { stage.clock.slept = 60'000'000'000; },
       {TickFault::suspended},
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
  std::int64_t ticks_to_zero;
  std::int64_t packets_to_detect;
  std::int64_t packets_with_force;  // of these
  bool is_latched;
  bool is_stop_confirmed;
  std::string stored;
};

Outcome outcome_of(std::uint16_t board, const Fault& fault, const State& state) {
  Stage stage{board};
  (stage.*state.reach)();
  REQUIRE(stage.loop->report().stopped_by == TickFault::none);
  fault.happen(stage);
  stage.bus.forget_requests();
  const std::int64_t before = stage.loop->report().ticks;
  const TickFault seen = (stage.*state.go_on)();
  auto sent = stage.bus.requests();
  std::erase_if(sent,
                [](const testing::Bytes& request) { return testing::outputs_in(request).empty(); });
  const auto with_force = std::ranges::count_if(
      sent, [](const testing::Bytes& request) { return !testing::has_no_force(request); });
  const bool is_confirmed =
      stage.last_stop.value_or(stage.loop->report().stop) == device::StopOutcome::confirmed;
  // after a halt is cleared, two of the three zeros are left
  REQUIRE((sent.size() >= 2 || !is_confirmed));
  CHECK((!is_confirmed || std::all_of(sent.end() - 2, sent.end(), testing::has_no_force)));
  const std::int64_t stopped_at = stage.loop->report().ticks;
  stage.tick(50);
  core::HandState hand;
  const bool is_latched = (!state.is_in_the_loop || stage.loop->report().ticks == stopped_at) &&
                          !stage.spidar.is_homed() &&
                          stage.spidar.read(hand, 1e-3) == TickFault::not_homed;
  const auto detected = std::ranges::find_if(sent, testing::has_no_force) - sent.begin();
  return {seen,
          state.is_in_the_loop ? stopped_at - before : detected,
          detected,
          with_force,
          is_latched,
          is_confirmed,
          state.is_in_the_loop ? core::to_text(stage.last_sample().fault) : "no trial yet: said"};
}

// How many packets with force on left after the fault began, and that it stays off.
void check_and_print(std::uint16_t board, const Fault& fault, const State& state) {
  CAPTURE(board, fault.name, state.name);
  const Outcome outcome = outcome_of(board, fault, state);
  testing::print({fault.name, state.name, outcome.ticks_to_zero, outcome.is_latched,
                  outcome.is_stop_confirmed, outcome.stored});
  CAPTURE(core::to_text(outcome.seen));
  CHECK(std::ranges::count(fault.seen_as, outcome.seen) == 1);
  CHECK((!state.is_in_the_loop || outcome.stored == core::to_text(outcome.seen)));
  CHECK(outcome.is_latched);
  CHECK(outcome.is_stop_confirmed == fault.is_stop_confirmed);
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
  const std::uint16_t board = GENERATE(device::sh4_product, device::simple_product);
  testing::print_fault_heading(
      fmt::format("SPIDAR-G6, {} board, behind libusb", device::board_of(board)->name()));
  for (const Fault& fault : all_faults()) {
    for (const State& state : states) {
      const bool is_seen = board == device::sh4_product || fault.is_seen_on_simple_board;
      if (is_seen && (state.is_in_the_loop || fault.is_seen_before_homing)) {
        check_and_print(board, fault, state);
      }
    }
  }
}

TEST_CASE("pressing on a plate through the whole chain gives the plate's force",
          "[device][safety][usb]") {
  Stage stage{GENERATE(device::sh4_product, device::simple_product)};
  stage.press();
  const core::TraceSample last = stage.last_sample();
  CHECK(last.touching);
  CHECK(last.force_n[1] == Approx(3000.0 * last.penetration_m));
  CHECK(last.achieved_n[1] == Approx(last.force_n[1]).epsilon(1e-4));
  // the muscle aims 12 mm deep and meets a spring of 3000 N/m: k d / (k + K)
  CHECK(last.penetration_m == Approx(400.0 * 0.012 / 3400.0).epsilon(0.05));
  CHECK(last.closure_margin > 0.0);
}
