#include "device/spidar/spidar_g6.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "core/techniques/technique.hpp"
#include "device/hand/penalty_limit.hpp"
#include "device/loop/haptic_loop.hpp"
#include "device/spidar/board.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
#include "support/usb/played_back.hpp"
#include "support/usb/spidar_on_bus.hpp"
using namespace tapstudy;
using device::DacCounts;
using device::Sh4Board;
using device::SimpleBoard;

TEST_CASE("an SH4 request carries its outputs little-endian from byte 2", "[device][spidar]") {
  const Sh4Board::Packet packet = Sh4Board::request({45, 3031, 0, 4095, 1, 2, 3, 256});
  CHECK(packet[0] == 0x01);
  CHECK(packet[1] == 0x0E);
  CHECK(packet[2] == 0x2D);
  CHECK(packet[3] == 0x00);
  CHECK(packet[4] == 0xD7);
  CHECK(packet[5] == 0x0B);
  CHECK(packet[16] == 0x00);
  CHECK(packet[17] == 0x01);
  CHECK(std::all_of(packet.begin() + 18, packet.end(), [](std::uint8_t b) { return b == 0; }));
}

TEST_CASE("an SH4 reply gives echo, counters and the rotary switch", "[device][spidar]") {
  Sh4Board::Packet reply{};
  reply[0] = 0xD7;
  reply[1] = 0x0B;
  reply[16] = 0xFF;
  reply[17] = 0x7F;
  reply[30] = 0x01;
  reply[31] = 0x80;
  reply[48] = 0xA5;
  const device::BoardReading reading = Sh4Board::reading_of(reply);
  CHECK(reading.echo->at(0) == 3031);
  CHECK(reading.counter[0] == 0x7FFF);
  CHECK(reading.counter[7] == 0x8001);
  CHECK(reading.rotary_switch() == 0xA);
}

TEST_CASE("a Simple board's packets are as its format says", "[device][spidar]") {
  const SimpleBoard::Packet packet = SimpleBoard::outputs({45, 3031, 0, 0, 0, 0, 0, 4095});
  CHECK(packet[0] == 0x52);
  CHECK(packet[1] == 45);
  CHECK(packet[3] == 0xD7);
  CHECK(packet[4] == 0x0B);
  CHECK(packet[15] == 0xFF);
  CHECK(packet[16] == 0x0F);
  SimpleBoard::Packet reply{};
  reply[21] = 0xFE;
  reply[22] = 0xFF;
  reply[23] = 0xFF;
  reply[24] = 0x30;
  const device::BoardReading reading = SimpleBoard::reading_of(reply);
  CHECK(reading.counter[7] == 0xFFFFFE);
  CHECK(reading.rotary_switch() == 3);
  CHECK(!reading.echo);
}

TEST_CASE("a Simple board is set up, then told outputs and asked to latch, in every exchange",
          "[device][spidar][usb]") {
  int latched = 0;
  testing::FakeBus bus{device::cyverse_vendor, device::simple_product,
                       [&](std::span<const std::uint8_t> request) {
                         testing::Bytes reply;
                         if (request[0] == 0x51) {  // the only command with a reply
                           reply.assign(32, 0);
                           reply[0] = static_cast<std::uint8_t>(++latched);
                           reply[24] = 0x50;
                         }
                         return reply;
                       }};
  device::UsbNode node = testing::node_of(bus);
  device::LibusbPipe pipe{node, {}, std::chrono::milliseconds{100}, testing::FakeBus::now};
  SimpleBoard board;
  device::BoardReading reading;
  REQUIRE(board.begin(pipe, reading) == device::UsbOutcome::ok);
  CHECK(reading.rotary_switch() == 5);
  REQUIRE(board.exchange(pipe, {1, 2, 3, 4, 5, 6, 7, 8}, reading) == device::UsbOutcome::ok);
  CHECK(reading.counter[0] == 2);
  std::vector<std::vector<int>> starts;
  for (const testing::Bytes& request : bus.requests()) {
    CHECK(request.size() == 32);
    starts.push_back({request[0], request[1], request[2]});
  }
  CHECK(starts == std::vector<std::vector<int>>{{0xA2, 0x1A, 0xFF},  // directions
                                                {0xA2, 0x19, 0xFF},  // counters cleared
                                                {0x52, 0, 0},
                                                {0x51, 0, 0},
                                                {0x52, 1, 0},
                                                {0x51, 0, 0}});
  bus.plan(testing::FakeBus::Trouble::missing, 1);
  CHECK(board.exchange(pipe, {}, reading) == device::UsbOutcome::timed_out);
}

TEST_CASE("counters that wrap are followed the shorter way", "[device][spidar]") {
  device::UnwrappedCounters counters{16};
  const auto all = [](std::uint32_t value) {
    device::RawCounters raw{};
    raw.fill(value);
    return raw;
  };
  CHECK(counters.take(all(65530)) == 0);
  CHECK(counters.take(all(5)) == 11);
  CHECK(counters.counts()[0] == 11);
  CHECK(counters.take(all(65530)) == 11);
  CHECK(counters.counts()[7] == 0);
  device::UnwrappedCounters wide{24};
  wide.take(all(0xFFFFFF));
  wide.take(all(1));
  CHECK(wide.counts()[3] == 2);
}

TEST_CASE("a counter that turns many times is followed for all its turns", "[device][spidar]") {
  device::UnwrappedCounters counters{16};
  device::RawCounters raw{};
  std::int64_t truth = 0;
  counters.take(raw);
  for (int i = 0; i < 100000; ++i) {
    truth += i < 60000 ? 300 : -299;
    raw.fill(static_cast<std::uint32_t>(truth & 0xFFFF));
    counters.take(raw);
  }
  CHECK(counters.counts()[0] == truth);
}

TEST_CASE("only boards whose format is known are driven", "[device][spidar]") {
  CHECK(device::board_of(device::sh4_product)->counter_bits() == 16);
  CHECK(device::board_of(device::simple_product)->counter_bits() == 24);
  CHECK(device::board_of(0x8613) == nullptr);
}

using core::TickFault;
using core::Vec3;
using testing::FakeBus;
using testing::SimulatedSpidar;
using Trouble = FakeBus::Trouble;

namespace {
struct Bench : testing::SpidarOnBus {
  explicit Bench(std::uint16_t board_product = device::sh4_product) : SpidarOnBus{board_product} {}
  void start() {
    for (int step = 1; step <= 500; ++step) {
      REQUIRE(spidar.tighten(step / 500.0) == TickFault::none);
    }
    REQUIRE(spidar.home() == TickFault::none);
    home_m = hardware.position_m();
  }
  // Under a force that changes with each tick.
  void start_and_tick(int ticks, const Vec3& force_n, const Vec3& change_n) {
    start();
    for (int i = 0; i < ticks; ++i) {
      REQUIRE(tick(force_n + i * change_n) == TickFault::none);
    }
  }
  TickFault tick(const Vec3& force_n, double elapsed_s = 1e-3) {
    core::HandState hand;
    const TickFault fault = spidar.read(hand, elapsed_s);
    seen = fault == TickFault::none ? hand : seen;
    return fault == TickFault::none ? spidar.write(force_n) : fault;
  }
  core::HandState seen;
  Vec3 home_m{Vec3::Zero()};  // the strings' own pull displaces the hand a little
};

// A SPIDAR that answers at once, and what it shares with a guardian.
struct Watched {
  testing::PlayedBack pipe;
  std::unique_ptr<device::SpidarBoard> board{device::board_of(device::sh4_product)};
  device::WatchdogChannel watch;
  device::SpidarG6 spidar{pipe, *board, [this] {
                            device::SpidarSettings settings = testing::simulated_settings();
                            settings.watchdog = &watch;
                            return settings;
                          }()};
};
}  // namespace

TEST_CASE("a SPIDAR starts with no force, tightens to its least tension and is homed",
          "[device][spidar][usb]") {
  Bench bench;
  for (const auto& request : bench.bus.requests()) {
    CHECK(testing::has_no_force(request));
  }
  core::HandState hand;
  CHECK(bench.spidar.read(hand, 1e-3) == TickFault::not_homed);
  bench.start();
  CHECK(bench.hardware.tension_n().minCoeff() == Approx(0.3).epsilon(0.03));
  CHECK(bench.hardware.tension_n().maxCoeff() <= 0.3);
  CHECK(bench.tick(Vec3::Zero()) == TickFault::none);
  CHECK(bench.seen.position_m.norm() < 1e-5);
  CHECK_THAT(bench.spidar.description(), Contains("rotary switch 3"));
}

TEST_CASE("a hundred thousand ticks follow the hand and give it the force that was asked",
          "[device][spidar][usb][slow]") {
  Bench bench;
  bench.hardware.start_counters_at(GENERATE(0, 65500));
  bench.start();
  double furthest_m = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const double t = 1e-3 * i;
    bench.hardware.hold_at({0.015 * std::sin(7.0 * t), 0.012 * std::sin(5.0 * t), 0.0});
    const Vec3 force_n{std::sin(t), 2.0 * std::cos(3.0 * t), 0.5};
    REQUIRE(bench.tick(force_n) == TickFault::none);
    const Vec3 truth_m = device::with_z_turned(bench.hardware.position_m() - bench.home_m);
    furthest_m = std::max(furthest_m, (truth_m - bench.seen.position_m).norm());
    CHECK((bench.spidar.detail().achieved_n - force_n).norm() < 1e-5);
  }
  CHECK(furthest_m < 2e-5);  // an encoder's step and a half
}

TEST_CASE("a force on the grip displaces the hand as its muscle's spring says",
          "[device][spidar][usb]") {
  Bench bench;
  bench.start();
  const Vec3 force_n = GENERATE(Vec3{2, 0, 0}, Vec3{0, -3, 0}, Vec3{0, 0, 2});
  for (int i = 0; i < 2000; ++i) {
    REQUIRE(bench.tick(force_n) == TickFault::none);
  }
  // tensions are whole DAC counts, 6.6 mN each, always rounded down
  CHECK((bench.seen.position_m - force_n / 400.0).norm() < 1e-4);
}

TEST_CASE("a loop on the grip ends in zero outputs, said three times, whatever goes wrong",
          "[device][spidar][usb]") {
  struct Case {
    Trouble trouble;
    TickFault fault;
  };
  const Case one = GENERATE(Case{Trouble::short_reply, TickFault::bad_reply},
                            Case{Trouble::stalled, TickFault::bad_reply},
                            Case{Trouble::protocol, TickFault::bad_reply},
                            Case{Trouble::overflow, TickFault::bad_reply},
                            Case{Trouble::not_accepted, TickFault::bad_reply});
  Bench bench;
  bench.start();
  for (int i = 0; i < 50; ++i) {
    REQUIRE(bench.tick({3, 0, 0}) == TickFault::none);
  }
  bench.bus.plan(one.trouble);
  CHECK(bench.tick({3, 0, 0}) == one.fault);
  bench.bus.forget_requests();
  CHECK(bench.spidar.emergency_stop() == device::StopOutcome::confirmed);
  const auto sent = bench.bus.requests();
  REQUIRE(sent.size() == 3);
  CHECK(std::ranges::all_of(sent, testing::has_no_force));
  core::HandState hand;
  CHECK(bench.spidar.read(hand, 1e-3) == TickFault::not_homed);
}

TEST_CASE("replies may be missing for 10 ms, and for a tenth of the time, at any rate",
          "[device][safety]") {
  const double dt_s = 1.0 / GENERATE(500.0, 1000.0, 8000.0);
  CAPTURE(dt_s);
  core::HandState hand;
  device::HeldHand held;
  CHECK_FALSE(held.use_last_reading(hand, dt_s));  // nothing is known
  held.keep(hand, dt_s);
  int missing = 0;
  while (held.use_last_reading(hand, dt_s)) {
    CHECK(held.unanswered_s() == Approx(++missing * dt_s));
  }
  CHECK(missing == std::lround(0.01 / dt_s));
  // one of so many is missing, for a minute
  const auto is_borne = [&](int of) {
    held.forget();
    bool is_so = true;
    for (int tick = 0; tick < 60.0 / dt_s && is_so; ++tick) {
      if (tick % of == 1) {
        is_so = held.use_last_reading(hand, dt_s);
      } else {
        held.keep(hand, tick % of == 2 ? 2.0 * dt_s : dt_s);
      }
    }
    return is_so;
  };
  CHECK(is_borne(10));
  CHECK_FALSE(is_borne(9));
}

TEST_CASE("replies may be missing in a row for 10 ms, then it is a fault",
          "[device][spidar][usb]") {
  const bool echoes_before = GENERATE(false, true);
  Bench bench;
  if (echoes_before) {
    bench.hardware.echo_the_request_before();
  }
  bench.start_and_tick(50, Vec3::Zero(), {0.01, 0, 0});
  const Vec3 last_m = bench.seen.position_m;
  for (int missed = 1; missed <= 10; ++missed) {
    bench.bus.plan(Trouble::missing);
    CHECK(bench.tick({0.01 * missed, 0, 0}) == TickFault::none);
    CHECK(bench.spidar.detail().missed_replies == missed);
    CHECK(bench.spidar.detail().unanswered_s == Approx(1e-3 * missed));
    CHECK(bench.seen.position_m == last_m);
  }
  SECTION("the next is there") {
    CHECK(bench.tick({0, 0, 0}) == TickFault::none);
    CHECK(bench.spidar.detail().missed_replies == 0);
    CHECK(bench.spidar.detail().unanswered_s == 0.0);
    CHECK(bench.tick({1, 0, 0}) == TickFault::none);
  }
  SECTION("the next is missing as well") {
    bench.bus.plan(Trouble::missing);
    CHECK(bench.tick({0, 0, 0}) == TickFault::no_reply);
  }
}

TEST_CASE("a late reply at the end of a trial does not cost the grip's home",
          "[device][spidar][usb]") {
  Bench bench;
  bench.start();
  REQUIRE(bench.tick({3, 0, 0}) == TickFault::none);
  bench.bus.plan(Trouble::missing);
  CHECK(bench.spidar.zero_force() == device::StopOutcome::confirmed);
  CHECK(bench.spidar.is_homed());
}

TEST_CASE("a trial ends once the board echoes that it has no force, be it a request late",
          "[device][spidar][safety][usb]") {
  const bool echoes_before = GENERATE(false, true);
  Bench bench;
  if (echoes_before) {
    bench.hardware.echo_the_request_before();
  }
  bench.start_and_tick(50, {3, 0, 0}, {0, 0, 0.01});
  bench.bus.forget_requests();
  CHECK(bench.spidar.zero_force() == device::StopOutcome::confirmed);
  CHECK(bench.bus.requests().size() == (echoes_before ? 2 : 1));
  CHECK(bench.spidar.is_homed());
}

TEST_CASE("after a late reply the position is again that of the tick, though nothing else changes",
          "[device][spidar][usb]") {
  Bench bench;
  bench.hardware.be_rigid();
  bench.start();
  for (int i = 0; i < 40; ++i) {
    const double x_m = 1e-4 * i;
    bench.hardware.put_at({x_m, 0.0, 0.0});
    if (i == 20) {
      bench.bus.plan(Trouble::late, 0, std::chrono::milliseconds{40});
    }
    REQUIRE(bench.tick(Vec3::Zero(), 0.005) == TickFault::none);
    if (i < 20 || i > 22) {
      CHECK(bench.seen.position_m.x() == Approx(x_m).margin(4e-5));
    }
  }
}

TEST_CASE("an amplifier that is switched off is a fault, however still the hand",
          "[device][spidar][safety]") {
  Bench bench;
  bench.hardware.be_rigid();
  bench.start();
  for (int i = 0; i < 50; ++i) {
    REQUIRE(bench.tick({0, 0, 0}) == TickFault::none);
  }
  CHECK(bench.spidar.detail().motor_voltage_v > 0.05);
  bench.hardware.switch_amplifier(false);
  int ticks = 0;
  TickFault fault = TickFault::none;
  for (; ticks < 100 && fault == TickFault::none; ++ticks) {
    fault = bench.tick({0, 0, 0});
  }
  CHECK(fault == TickFault::amplifier_off);
  CHECK(ticks < 25);
  CHECK_FALSE(bench.spidar.has_motor_voltage());
}

TEST_CASE("a speed is a distance by the time that passed, however late the tick",
          "[device][spidar]") {
  const double late_by_s = GENERATE(0.0, 0.002, 0.005, 0.010, 0.020);
  CAPTURE(late_by_s);
  constexpr double speed_m_s = 0.3;
  constexpr double from_m = -0.012;
  Bench bench;
  bench.hardware.be_rigid();
  bench.start();
  bench.hardware.put_at({from_m, 0.0, 0.0});
  REQUIRE(bench.spidar.begin() == TickFault::none);
  double time_s = 0.0;
  for (int i = 0; i < 50; ++i) {
    const double elapsed_s = i == 40 ? 0.001 + late_by_s : 0.001;
    time_s += elapsed_s;
    bench.hardware.put_at({from_m + speed_m_s * time_s, 0.0, 0.0});
    REQUIRE(bench.tick(Vec3::Zero(), elapsed_s) == TickFault::none);
    if (i >= 25) {
      CHECK(bench.seen.velocity_m_s.x() == Approx(speed_m_s).epsilon(0.05));
    }
  }
}

TEST_CASE("a halted endpoint is cleared, and an unconfirmed stop is said to be one",
          "[device][spidar][safety][usb]") {
  Bench bench;
  bench.start();
  for (int i = 0; i < 50; ++i) {
    REQUIRE(bench.tick({3, 0, 0}) == TickFault::none);
  }
  SECTION("halted until it is cleared") {
    bench.bus.halt_out(1);
    CHECK(bench.tick({3, 0, 0}) == TickFault::bad_reply);
    CHECK(bench.spidar.emergency_stop() == device::StopOutcome::confirmed);
    CHECK(bench.hardware.tension_n().maxCoeff() == 0.0);
    CHECK(bench.spidar.is_force_off());
  }
  SECTION("halted for good") {
    bench.bus.halt_out(1'000'000);
    CHECK(bench.tick({3, 0, 0}) == TickFault::bad_reply);
    CHECK(bench.spidar.emergency_stop() == device::StopOutcome::unconfirmed);
    CHECK_FALSE(bench.spidar.is_force_off());
  }
  SECTION("not taken, or taken and lost") {
    bench.bus.persist_in(GENERATE(Trouble::out_nak, Trouble::out_lost));
    CHECK(bench.spidar.emergency_stop() == device::StopOutcome::unconfirmed);
    CHECK_FALSE(bench.spidar.is_force_off());
  }
}

TEST_CASE(
    "counters that stand still under force end it: 3 s after they did, or 50 ms after a newton",
    "[device][spidar][safety]") {
  Bench bench{GENERATE(device::sh4_product, device::simple_product)};
  bench.start();
  const auto ticks_until_fault = [&](const Vec3& force_n) {
    int ticks = 0;
    while (ticks < 20'000 && bench.tick(force_n) == TickFault::none) {
      ++ticks;
    }
    CHECK(bench.tick(force_n) == TickFault::position_frozen);
    return ticks;
  };
  for (int i = 0; i < 30; ++i) {  // the hand is still on its way
    REQUIRE(bench.tick({0.0, 2.5, 0.0}) == TickFault::none);
  }
  bench.hardware.stop_counting();
  SECTION("under a steady force") {
    CHECK(ticks_until_fault({0.0, 2.5, 0.0}) == Approx(3000).margin(2));
  }
  SECTION("under one that changed, wherever the hand is meanwhile") {
    bench.hardware.hold_at({0.0, 0.015, 0.0});
    REQUIRE(bench.tick({0.0, 1.4, 0.0}) == TickFault::none);
    CHECK(ticks_until_fault({0.0, 1.4, 0.0}) == Approx(50).margin(2));
  }
}

TEST_CASE("a hand at rest, a grip that nobody holds and a vibration are not taken for frozen",
          "[device][spidar][safety]") {
  Bench bench;
  bench.hardware.be_rigid();
  bench.start();
  SECTION("a hand ten times stiller than most") {
    for (int i = 0; i < 20'000; ++i) {
      const double t_s = 1e-3 * i;
      const double given_way_m = 2.5 / 4000.0 * (1.0 - std::exp(-t_s / 0.005));
      bench.hardware.put_at(
          {5e-5 * t_s, given_way_m + 1.8e-6 * std::sin(2.0 * M_PI * 9.0 * t_s), 0.0});
      REQUIRE(bench.tick({0.0, 2.5, 0.0}) == TickFault::none);
    }
  }
  SECTION("a grip at rest without force") {
    for (int i = 0; i < 20'000; ++i) {
      REQUIRE(bench.tick({0.0, 0.45, 0.0}) == TickFault::none);
    }
  }
  SECTION("a vibration too fast for a hand to follow") {
    for (int i = 0; i < 2500; ++i) {
      REQUIRE(bench.tick({0.0, 1.5 + std::sin(2.0 * M_PI * 200.0 * 1e-3 * i), 0.0}) ==
              TickFault::none);
    }
  }
}

namespace {
// A SPIDAR as a session opens it, with its guardian in a process of its own.
struct Guarded {
  explicit Guarded(std::uint16_t board_product) : product{board_product} {}
  std::uint16_t product;
  SimulatedSpidar hardware;
  std::atomic<double> strongest_n{0.0};
  FakeBus bus{device::cyverse_vendor, product, [this](auto request) {
                const testing::Bytes reply = hardware.answer(request);
                strongest_n = hardware.tension_n().maxCoeff();
                return reply;
              }};
  device::UsbNode node{testing::node_of(bus)};
  std::unique_ptr<device::SpidarBoard> board{device::board_of(product)};
  // a busy machine may keep the test from beating for long
  device::Guardian guardian{node, {0x02, 0x86, board->zero_force_packet(), 20.0, 0, -1}};
  device::LibusbPipe pipe{node, {}, std::chrono::milliseconds{25}, testing::FakeBus::now};
  device::SpidarG6 spidar{pipe, *board, [this] {
                            device::SpidarSettings settings = testing::simulated_settings();
                            settings.watchdog = &guardian.channel();
                            return settings;
                          }()};

  void pull() {
    for (int step = 1; step <= 50; ++step) {
      REQUIRE(spidar.tighten(step / 50.0) == TickFault::none);
    }
    REQUIRE(spidar.home() == TickFault::none);
    REQUIRE(spidar.begin() == TickFault::none);
    REQUIRE(tick() == TickFault::none);
    REQUIRE(tick() == TickFault::none);
    REQUIRE(strongest_n > 1.0);
  }
  TickFault tick() {
    core::HandState hand;
    const TickFault fault = spidar.read(hand, 1e-3);
    return fault == TickFault::none ? spidar.write({0.0, 3.0, 0.0}) : fault;
  }
  void pass_rounds(std::uint64_t count) {
    const std::uint64_t from = guardian.channel().rounds();
    while (guardian.channel().rounds() < from + count) {
      usleep(1000);
    }
  }
};
}  // namespace

TEST_CASE(
    "of a board that takes every packet and answers none, force is not off until a reply says so",
    "[device][spidar][safety][usb]") {
  Guarded guarded{GENERATE(device::sh4_product, device::simple_product)};
  guarded.pull();
  guarded.bus.persist_in(Trouble::out_lost);
  TickFault fault = TickFault::none;
  for (int i = 0; i < 20 && fault == TickFault::none; ++i) {
    fault = guarded.tick();
  }
  CHECK(fault == TickFault::no_reply);
  CHECK(guarded.spidar.emergency_stop() == device::StopOutcome::unconfirmed);
  guarded.pass_rounds(20);
  CHECK_FALSE(guarded.spidar.is_force_off());
  CHECK(guarded.strongest_n > 1.0);
  CHECK_FALSE(guarded.guardian.channel().may_close_relay());
  guarded.bus.persist_in(Trouble::none);
  for (int i = 0; i < 1000 && !guarded.spidar.is_force_off(); ++i) {
    guarded.pass_rounds(1);
  }
  CHECK(guarded.spidar.is_force_off());
  CHECK(guarded.strongest_n == 0.0);
  CHECK_FALSE(guarded.guardian.channel().may_close_relay());
}

TEST_CASE(
    "a wall on the grip rests up to the bound of a force that acts a tick late, and chatters "
    "above",
    "[device][spidar][stability]") {
  const double part = GENERATE(0.85, 1.15);
  const double penalty_n_per_m =
      part * device::largest_stable_penalty_n_per_m(core::HandBody{}, 1e-3, 1);
  Bench bench;
  bench.start();
  bench.hardware.hold_at({0.0, -0.012, 0.0});
  double low_n = 1e9;
  double high_n = 0.0;
  for (int i = 0; i < 3000; ++i) {
    core::HandState hand;
    REQUIRE(bench.spidar.read(hand, 1e-3) == TickFault::none);
    const double share = std::min(1.0, i / 1000.0);  // no impact, which would bounce
    const double force_n = std::clamp(-share * penalty_n_per_m * hand.position_m.y(), 0.0, 8.0);
    REQUIRE(bench.spidar.write({0.0, force_n, 0.0}) == TickFault::none);
    if (i > 2000) {
      low_n = std::min(low_n, force_n);
      high_n = std::max(high_n, force_n);
    }
  }
  CAPTURE(penalty_n_per_m, low_n, high_n);
  // at rest it still follows the encoders' steps
  CHECK((high_n - low_n > 1.0) == (part > 1.0));
}

TEST_CASE("a late reply within the time allowed is no fault", "[device][spidar][usb]") {
  Bench bench;
  bench.start();
  bench.bus.plan(Trouble::late, 0, std::chrono::milliseconds{1});
  CHECK(bench.tick(Vec3::Zero()) == TickFault::none);
}

TEST_CASE("what the board gets wrong is seen", "[device][spidar][usb]") {
  Bench bench;
  bench.start();
  REQUIRE(bench.tick({1, 0, 0}) == TickFault::none);
  SECTION("an echo of what was never sent") {
    bench.hardware.echo_wrongly();
    CHECK(bench.tick({1, 0, 0}) == TickFault::wrong_echo);
  }
  SECTION("a counter that jumps") {
    bench.hardware.jump(3, 400);
    CHECK(bench.tick({1, 0, 0}) == TickFault::counter_jumped);
    // neither was measured in this tick
    CHECK(std::isnan(bench.spidar.detail().pose_residual_m));
    CHECK(std::isnan(bench.spidar.detail().closure_margin));
  }
  SECTION("a string that slips") {
    TickFault fault = TickFault::none;
    for (int i = 0; i < 300 && fault == TickFault::none; ++i) {
      bench.hardware.jump(3, 1);  // 17 um a tick: no jump, and every pose is found
      fault = bench.tick({1, 0, 0});
    }
    CHECK(fault == TickFault::strings_disagree);
    CHECK(bench.spidar.detail().pose_residual_m < 2.2e-4);
  }
}

TEST_CASE("a reply of a tick ago is told from this one's, whichever request the board echoes",
          "[device][spidar][usb]") {
  Bench bench;
  if (GENERATE(false, true)) {
    bench.hardware.echo_the_request_before();
  }
  bench.start_and_tick(100, Vec3::Zero(), {0.02, 0, 0});
  bench.bus.plan(Trouble::stale);
  CHECK(bench.tick({3, 0, 0}) == TickFault::wrong_echo);
}

TEST_CASE("with force on, a SPIDAR is watched and its guardian with it",
          "[device][spidar][safety]") {
  Watched watched;
  device::WatchdogChannel& watch = watched.watch;
  device::SpidarG6& spidar = watched.spidar;
  REQUIRE(spidar.tighten(1.0) == TickFault::none);
  REQUIRE(spidar.home() == TickFault::none);
  CHECK_FALSE(watch.is_on());
  std::jthread guardian{[&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      watch.complete_round();
      usleep(1000);
    }
  }};
  REQUIRE(spidar.begin() == TickFault::none);
  guardian = {};
  CHECK(watch.is_on());
  core::HandState hand;
  const auto tick = [&] {
    const std::uint64_t beats = watch.beats();
    const TickFault fault = spidar.read(hand, 1e-3);
    CHECK(watch.beats() == beats + 1);
    return fault;
  };
  SECTION("a guardian that acted ends it") {
    REQUIRE(tick() == TickFault::none);
    watch.take_output_over();
    CHECK(tick() == TickFault::watchdog_expired);
  }
  SECTION("a guardian that is silent for a tenth of a second ends it") {
    int ticks = 0;
    for (; ticks < 3000 && tick() == TickFault::none; ++ticks) {
      if (ticks < 1000 && ticks % 90 == 0) {
        watch.complete_round();
      }
    }
    CHECK(ticks == Approx(990 + 101).margin(2));
    CHECK(tick() == TickFault::guardian_lost);
  }
  SECTION("at rest nobody need watch") {
    CHECK(spidar.zero_force() == device::StopOutcome::confirmed);
    CHECK_FALSE(watch.is_on());
  }
  SECTION("nor after a fault") {
    CHECK(spidar.emergency_stop() == device::StopOutcome::confirmed);
    CHECK_FALSE(watch.is_on());
  }
  SECTION("unless zero force was not confirmed: then the guardian repeats it") {
    watched.pipe.fail_from_now_on();
    CHECK(spidar.emergency_stop() == device::StopOutcome::unconfirmed);
    CHECK(watch.is_on());
    CHECK(watch.must_repeat());
    CHECK_FALSE(spidar.is_force_off());
    watch.note_zero_confirmed();
    CHECK(spidar.is_force_off());
  }
  SECTION("an output that the guardian takes in the middle of an exchange is the guardian's") {
    REQUIRE(tick() == TickFault::none);
    watched.pipe.in_the_middle_of_an_exchange([&] { watch.take_output_over(); });
    CHECK(tick() == TickFault::watchdog_expired);
  }
}

TEST_CASE("without a guardian that is seen to be alive there is no force",
          "[device][spidar][safety]") {
  Watched watched;
  CHECK(watched.spidar.begin() == TickFault::guardian_lost);
  CHECK_FALSE(watched.watch.is_on());
}

TEST_CASE("a thousand ticks of the loop on a SPIDAR allocate nothing",
          "[device][spidar][realtime]") {
  testing::PlayedBack pipe;
  const auto board = device::board_of(device::sh4_product);
  device::SpidarG6 spidar{pipe, *board, testing::simulated_settings()};
  REQUIRE(spidar.home() == TickFault::none);
  std::vector<core::TapRenderer> renderers;
  renderers.push_back(core::make_renderer(*core::find_technique("none"), core::RenderSettings{},
                                          core::PlateFace{0.3, 0.3}, nullptr));
  core::SpscRing<core::TraceSample> trace{2048};
  device::VirtualClock clock;
  device::HapticLoop loop{spidar, renderers, {}, trace, clock};
  const testing::AllocationCount allocations;
  loop.run_ticks(1000);
  CHECK(allocations.count() == 0);
  CHECK(loop.report().stopped_by == TickFault::none);
  CHECK(loop.report().ticks == 1000);
}

TEST_CASE("an unplugged device is told in every phase, without hanging", "[device][spidar][usb]") {
  Bench bench;
  const int phase = GENERATE(0, 1, 2, 3);
  if (phase == 0) {
    bench.bus.unplug();
    CHECK(bench.spidar.tighten(0.1) == TickFault::device_gone);
    return;
  }
  bench.start();
  if (phase == 1) {
    bench.bus.unplug();
  } else if (phase == 2) {
    bench.bus.plan(Trouble::unplugged);
  } else {
    REQUIRE(bench.tick({1, 0, 0}) == TickFault::none);
    bench.bus.plan(Trouble::unplugged);
  }
  CHECK(bench.tick({1, 0, 0}) == TickFault::device_gone);
  CHECK(bench.tick({1, 0, 0}) != TickFault::none);
  bench.spidar.emergency_stop();
}

TEST_CASE("a board that does not answer is refused at once", "[device][spidar][usb]") {
  SimulatedSpidar hardware;
  FakeBus bus{device::cyverse_vendor, device::sh4_product,
              [](std::span<const std::uint8_t>) { return testing::Bytes{}; }};
  const device::UsbNode node{testing::node_of(bus)};
  device::LibusbPipe pipe{node, {}, std::chrono::milliseconds{3}, testing::FakeBus::now};
  const auto board = device::board_of(device::sh4_product);
  CHECK_THROWS_WITH((device::SpidarG6{pipe, *board, testing::simulated_settings()}),
                    Contains("does not answer: no reply in time"));
}
