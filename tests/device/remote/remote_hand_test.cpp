#include "device/remote/remote_hand.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cstring>
#include <deque>
#include <limits>
#include <numbers>
#include <thread>
#include <vector>

#include "core/random/rng.hpp"
#include "device/hand/prescribed_hand.hpp"
#include "device/remote/packets.hpp"
#include "support/bridges/rogue_sender.hpp"
#include "support/catch.hpp"
#include "support/example_bridge.hpp"
#include "support/remote_program.hpp"
#include "support/staged_loop.hpp"
using namespace tapstudy;
using core::TickFault;
using core::Vec3;

using testing::ExampleBridge;
using testing::free_port;
using testing::RogueSender;
using testing::unhurried;

namespace {
// The next reading. Where this program was kept waiting for 20 ms, the bridge has released the
// force and says so, truthfully: then the next trial begins.
TickFault read_again(device::RemoteHand& hand, core::HandState& state) {
  TickFault fault = hand.read(state, 1e-3);
  while (fault == TickFault::force_released) {
    static_cast<void>(hand.begin());
    fault = hand.read(state, 1e-3);
  }
  return fault;
}
}  // namespace

TEST_CASE("a request lies on the wire as documented", "[device][remote]") {
  const auto bytes = device::encoded(
      device::RemoteRequest{device::RequestKind::no_reply, 0x01020304U, Vec3{0.0, -2.0, 1.0}});
  CHECK(std::memcmp(bytes.data(), "TAPS\x02\0\0\0\x04\x03\x02\x01", 12) == 0);
  CHECK(bytes[20 + 7] == 0xC0);  // -2 = C0 00 … big end last
  CHECK(bytes[28 + 7] == 0x3F);
  CHECK(bytes[28 + 6] == 0xF0);
}

TEST_CASE("what is no reply is none", "[device][remote]") {
  std::array<std::uint8_t, device::reply_bytes> bytes{'T', 'A', 'P', 'R', 1};
  CHECK(device::decoded_reply(bytes));
  CHECK(!device::decoded_reply(std::span{bytes}.first(59)));
  bytes[4] = 2;
  CHECK(!device::decoded_reply(bytes));
  bytes[4] = 1;
  bytes[0] = 'X';
  CHECK(!device::decoded_reply(bytes));
}

namespace {
// Bound to any free port of the loopback; its address is returned in `address`.
int open_socket(sockaddr& address) {
  const int opened = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in any{};
  any.sin_family = AF_INET;
  any.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address = std::bit_cast<sockaddr>(any);
  socklen_t size = sizeof address;
  REQUIRE(bind(opened, &address, size) == 0);
  REQUIRE(getsockname(opened, &address, &size) == 0);
  return opened;
}
std::uint16_t port_of(const sockaddr& address) {
  return ntohs(std::bit_cast<sockaddr_in>(address).sin_port);
}
}  // namespace

TEST_CASE(
    "a socket of the loopback carries datagrams whole, is silent until the deadline, and tells of "
    "a "
    "closed port",
    "[device][remote]") {
  sockaddr generic{};
  socklen_t size = sizeof generic;
  const int other = open_socket(generic);
  const auto pipe = device::open_udp_pipe(port_of(generic));
  const std::array<std::uint8_t, 5> sent{1, 2, 3, 4, 5};
  std::array<std::uint8_t, 8> got{};
  REQUIRE(pipe->send(sent) == device::DatagramOutcome::ok);
  REQUIRE(recvfrom(other, got.data(), got.size(), 0, &generic, &size) == 5);
  REQUIRE(sendto(other, got.data(), 5, 0, &generic, size) == 5);
  const device::Nanoseconds unhurried_ns = std::chrono::nanoseconds{unhurried}.count();
  const auto received = pipe->receive(got, pipe->now() + unhurried_ns);
  CHECK(received.outcome == device::DatagramOutcome::ok);
  CHECK(received.bytes == 5);
  CHECK(std::equal(sent.begin(), sent.end(), got.begin()));
  const device::Nanoseconds deadline = pipe->now() + 2'000'000;
  CHECK(pipe->receive(got, deadline).outcome == device::DatagramOutcome::timed_out);
  CHECK(pipe->now() >= deadline);
  close(other);
  REQUIRE(pipe->send(sent) == device::DatagramOutcome::ok);
  CHECK(pipe->receive(got, pipe->now() + unhurried_ns).outcome == device::DatagramOutcome::gone);
}

namespace {
std::atomic<int> signals_taken{0};
}  // namespace

TEST_CASE("a signal that comes while a reply is waited for is no missing reply",
          "[device][remote][threads]") {
  sockaddr generic{};
  socklen_t size = sizeof generic;
  const int other = open_socket(generic);
  const auto pipe = device::open_udp_pipe(port_of(generic));
  std::array<std::uint8_t, 8> got{};
  REQUIRE(pipe->send(got) == device::DatagramOutcome::ok);
  REQUIRE(recvfrom(other, got.data(), got.size(), 0, &generic, &size) == 8);
  const auto usual = signal(SIGUSR1, [](int) { ++signals_taken; });
  device::ReceivedDatagram received;
  std::atomic<bool> has_ended{false};
  std::thread waiting{[&] {
    received = pipe->receive(got, pipe->now() + std::chrono::nanoseconds{unhurried}.count());
    has_ended = true;
  }};
  while (signals_taken < 1000 && !has_ended) {
    pthread_kill(waiting.native_handle(), SIGUSR1);
  }
  CHECK(sendto(other, "reply", 5, 0, &generic, size) == 5);
  waiting.join();
  signal(SIGUSR1, usual);
  close(other);
  CHECK(received.outcome == device::DatagramOutcome::ok);
}

TEST_CASE("the bridge's finger moves under the force it is sent", "[device][remote]") {
  const std::uint16_t port = free_port();
  ExampleBridge bridge{port};
  device::RemoteHand hand{port, {unhurried}};
  core::HandState state;
  double sideways_m = 0.0;
  for (int i = 0; i < 2000; ++i) {
    REQUIRE(read_again(hand, state) == TickFault::none);
    REQUIRE(hand.write({1.0, 0.0, 0.0}) == TickFault::none);
    sideways_m = state.position_m.x();
  }
  CHECK(sideways_m == Approx(1.0 / 400.0).epsilon(0.01));  // the example's muscle
  bridge.end();
  TickFault fault = TickFault::none;
  for (int i = 0; i < 3 && fault == TickFault::none; ++i) {
    fault = hand.read(state, 1e-3);
  }
  CHECK((fault == TickFault::device_gone || fault == TickFault::no_reply));
}

TEST_CASE("a replayed hand goes where the recorded one went, and stays there", "[device][replay]") {
  device::ReplayHand hand{{{Vec3{1, 0, 0}, Vec3{0, 1, 0}}, {Vec3{2, 0, 0}, Vec3{0, 2, 0}}},
                          "a test"};
  core::HandState state;
  for (int turn = 0; turn < 2; ++turn) {
    CHECK(hand.read(state, 1e-3) == TickFault::none);
    CHECK(state.position_m == Vec3{1, 0, 0});
    CHECK(hand.read(state, 1e-3) == TickFault::none);
    CHECK(state.velocity_m_s == Vec3{0, 2, 0});
    CHECK(hand.read(state, 1e-3) == TickFault::none);
    CHECK(state.position_m == Vec3{2, 0, 0});
    CHECK(state.velocity_m_s == Vec3::Zero());
    hand.rewind();
  }
}

TEST_CASE("the example bridge obeys one sender, and never more force than the device may exert",
          "[device][remote][safety]") {
  const std::uint16_t port = free_port();
  const ExampleBridge bridge{port};
  device::RemoteHand hand{port, {unhurried}};
  RogueSender rogue{port};
  core::HandState state;
  REQUIRE(hand.write({0.0, 2.0, 0.0}) == TickFault::none);
  for (int i = 0; i < 200; ++i) {
    rogue.send({0.0, -9.0, 0.0});
    REQUIRE(read_again(hand, state) == TickFault::none);
    REQUIRE(hand.detail().achieved_n == Vec3{0.0, 2.0, 0.0});
  }
  REQUIRE(hand.write({300.0, 400.0, 0.0}) == TickFault::none);
  REQUIRE(read_again(hand, state) == TickFault::none);
  CHECK(hand.detail().achieved_n.isApprox(Vec3{3.0, 4.0, 0.0}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  REQUIRE(hand.write({1.0, nan, 0.0}) == TickFault::none);
  CHECK(hand.zero_force() == device::StopOutcome::confirmed);
  CHECK(hand.detail().achieved_n == Vec3::Zero());
}

TEST_CASE("the example bridge obeys no request that is older than the last one",
          "[device][remote][safety]") {
  const std::uint16_t port = free_port();
  const ExampleBridge bridge{port};
  RogueSender sender{port};
  std::uint32_t last = 0;
  do {  // until it listens
    sender.ask(++last, Vec3::Zero());
  } while (!sender.next_reply(std::chrono::milliseconds{50}));
  while (sender.next_reply(std::chrono::milliseconds{50})) {
  }
  sender.ask(last + 2, {1.0, 0.0, 0.0});
  sender.ask(last + 1, {3.0, 0.0, 0.0});
  sender.ask(last + 2, {3.0, 0.0, 0.0});
  sender.ask(last + 3, {2.0, 0.0, 0.0});
  for (std::uint32_t number = last; number != last + 3;) {  // those that wait are one: the newest
    const auto reply = sender.next_reply();
    REQUIRE(reply);
    REQUIRE(reply->number > number);
    number = reply->number;
    CHECK(reply->exerted_n->x() <= (number == last + 3 ? 2.0 : 1.0));
  }
}

TEST_CASE(
    "a bridge that was stopped exerts none of the requests that waited, and answers the newest",
    "[device][remote][safety]") {
  const std::uint16_t port = free_port();
  ExampleBridge bridge{port};
  RogueSender sender{port};
  std::uint32_t last = 0;
  const auto is_exerted = [&] {
    sender.ask(++last, {1.0, 0.0, 0.0});
    const auto reply = sender.next_reply(std::chrono::milliseconds{50});
    return reply && reply->number == last && reply->exerted_n == Vec3{1.0, 0.0, 0.0};
  };
  while (!is_exerted()) {
  }
  bridge.stop();
  for (int i = 0; i < 5; ++i) {
    sender.ask(++last, {1.0, 0.0, 0.0});
  }
  std::this_thread::sleep_for(std::chrono::milliseconds{25});  // longer than force may outlast one
  bridge.go_on();
  const auto reply = sender.next_reply();
  REQUIRE(reply);
  CHECK(reply->number == last);
  CHECK(reply->exerted_n == Vec3::Zero());
  CHECK((*reply->status & device::wire::force_was_released) != 0);
}

TEST_CASE("the example bridge lets go of the force when nobody asks", "[device][remote][safety]") {
  const std::uint16_t port = free_port();
  const ExampleBridge bridge{port};
  device::RemoteHand hand{port, {unhurried}};
  CHECK(hand.release_after(std::chrono::milliseconds{150}) ==
        device::RemoteHand::Release::released);
}

TEST_CASE("a remote stop is confirmed by a reply, or it is not a stop",
          "[device][remote][safety]") {
  const std::uint16_t port = free_port();
  ExampleBridge bridge{port};
  device::RemoteHand hand{port, {unhurried}};
  CHECK(hand.emergency_stop() == device::StopOutcome::confirmed);
  bridge.end();
  CHECK(hand.emergency_stop() == device::StopOutcome::unconfirmed);
}

using device::DatagramOutcome;
using device::Nanoseconds;
using testing::ProgramClock;
using testing::RemoteProgram;
using testing::RemoteTrouble;
using namespace std::chrono_literals;

namespace {
constexpr auto max_reply = 5ms;

struct Stage {
  explicit Stage(int version = 2, double rate_hz = 1000.0) : owned{program_of(version, rate_hz)} {}
  static std::unique_ptr<RemoteProgram> program_of(int version, double rate_hz) {
    auto program = std::make_unique<RemoteProgram>(version);
    program->introduction.rate_hz = rate_hz;
    return program;
  }
  std::unique_ptr<RemoteProgram> owned;
  RemoteProgram& program{*owned};
  device::RemoteHand hand{40'000, {max_reply}, std::move(owned)};
  ProgramClock clock{program};
  testing::StagedLoop loop{hand, clock};

  void press() {
    loop.tick(200);
    for (int i = 1; i <= 100; ++i) {
      program.height_m = 0.01 - 1.1e-4 * i;  // 1 mm deep, slowly enough
      loop.tick(1);
    }
    loop.tick(1);  // in version 3 a force acts a tick later
    REQUIRE(program.exerted_n == Approx(3.0).epsilon(0.01));
  }
};
}  // namespace

TEST_CASE("a request of version 3 lies on the wire as documented", "[device][remote]") {
  const auto bytes = device::encoded(device::wire::Request{
      .number = 0x01020304U, .force_n = {0.0, -2.0, 1.0}, .torque_n_m = {0.0, 0.0, 4.0}});
  CHECK(bytes.size() == 64);
  CHECK(std::memcmp(bytes.data(), "TAP3\x01\0\0\0\x04\x03\x02\x01\0\0\0\0", 16) == 0);
  CHECK(bytes[24 + 7] == 0xC0);  // -2 = C0 00 … big end last
  CHECK(bytes[32 + 7] == 0x3F);
  CHECK(bytes[56 + 7] == 0x40);  // 4 = 40 10 …
  CHECK(bytes[56 + 6] == 0x10);
}

namespace {
using device::wire::Introduction;
using device::wire::Reply;
template <class Datagram>
std::vector<std::uint8_t> bytes_of(const Datagram& datagram) {
  std::vector<std::uint8_t> bytes(sizeof datagram);
  std::memcpy(bytes.data(), &datagram, sizeof datagram);
  return bytes;
}
constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
}  // namespace

TEST_CASE("a text that is replaced while it is read is read whole", "[device][remote][threads]") {
  using Text = device::SharedText<96>;
  const auto text_of = [](char letter, std::size_t length) {
    Text::Characters text{};
    std::fill_n(text.begin(), length, letter);
    return text;
  };
  Text text;
  text.set(text_of('a', 95));
  std::jthread writer{[&] {
    for (int i = 0; i < 200'000; ++i) {
      text.set(i % 2 == 0 ? text_of('b', 40) : text_of('a', 95));
    }
    text.set(text_of('c', 3));
  }};
  std::string read;
  int torn = 0;
  while (read != "ccc") {
    read = text.get();
    torn += static_cast<int>(read != std::string(95, 'a') && read != std::string(40, 'b') &&
                             read != "ccc");
  }
  CHECK(torn == 0);
}

TEST_CASE("a reply of version 3 that breaks a rule of the format is none", "[device][remote]") {
  const Reply valid;
  REQUIRE(device::decoded_reply(bytes_of(valid)));
  const auto change = [&](const auto& changed_by) {
    Reply changed = valid;
    changed_by(changed);
    return device::decoded_reply(bytes_of(changed)).has_value();
  };
  CHECK(change([](Reply& reply) { reply.velocity_m_s.fill(not_known); }));
  CHECK(change([](Reply& reply) { reply.orientation.fill(not_known); }));
  CHECK(change([](Reply& reply) { reply.exerted_n.fill(not_known); }));
  CHECK(change([](Reply& reply) { reply.text = {"move the grip to the middle"}; }));
  CHECK(!change([](Reply& reply) { reply.mark[3] = '4'; }));
  CHECK(!change([](Reply& reply) { reply.age_s = -1e-6; }));
  CHECK(!change([](Reply& reply) { reply.age_s = not_known; }));
  CHECK(!change([](Reply& reply) { reply.velocity_m_s[1] = not_known; }));
  CHECK(!change([](Reply& reply) { reply.exerted_n[1] = HUGE_VAL; }));
  CHECK(!change([](Reply& reply) { reply.exerted_n_m[1] = not_known; }));
  CHECK(!change([](Reply& reply) { reply.orientation = {0.0, 0.0, 0.0, 0.0}; }));
  CHECK(!change([](Reply& reply) { reply.orientation = {0.8, 0.0, 0.0, 0.8}; }));
  CHECK(!change([](Reply& reply) { reply.orientation[0] = HUGE_VAL; }));
  CHECK(!change([](Reply& reply) { reply.text[0] = '\n'; }));
  CHECK(!change([](Reply& reply) { reply.text[0] = '\x80'; }));
  CHECK(!change([](Reply& reply) { reply.text.fill('a'); }));
  CHECK(!change([](Reply& reply) { reply.text[2] = 'a'; }));  // after the end
  auto bytes = bytes_of(valid);
  bytes.push_back(0);
  CHECK(!device::decoded_reply(bytes));
  bytes.resize(255);
  CHECK(!device::decoded_reply(bytes));
}

TEST_CASE("an introduction that breaks a rule of the format is none", "[device][remote]") {
  const Introduction valid = RemoteProgram{3}.introduction;
  REQUIRE(device::decoded_introduction(bytes_of(valid), 0));
  CHECK(!device::decoded_introduction(bytes_of(valid), 1));
  const auto change = [&](const auto& changed_by) {
    Introduction changed = valid;
    changed_by(changed);
    return device::decoded_introduction(bytes_of(changed), 0).has_value();
  };
  CHECK(!change([](Introduction& told) { told.measured_axes = 5; }));
  CHECK(!change([](Introduction& told) { told.driven_axes = 7; }));
  CHECK(!change([](Introduction& told) { told.name[0] = '\x1b'; }));
}

TEST_CASE(
    "an introduction that says what no device is, is refused with the value and what is allowed",
    "[device][remote][safety]") {
  for (const device::wire::Limit& limit : device::wire::limits) {
    for (const double absurd :
         {0.0, -1.0, not_known, HUGE_VAL, 1e9, std::nextafter(limit.least, 0.0),
          std::nextafter(limit.greatest, HUGE_VAL)}) {
      CAPTURE(limit.name, absurd);
      auto program = std::make_unique<RemoteProgram>(3);
      program->introduction.*limit.value = absurd;
      CHECK_THROWS_WITH(
          (device::RemoteHand{40'000, {max_reply}, std::move(program)}),
          Contains(fmt::format("'a mock' introduces itself with a {} of {:.6g} {}", limit.name,
                               absurd, limit.unit)) &&
              Contains(fmt::format("only {:.6g} to {:.6g}", limit.least, limit.greatest)));
    }
  }
}

TEST_CASE(
    "one datagram goes each way in a tick of version 3; a force acts a tick after its position",
    "[device][remote]") {
  Stage stage{3};
  stage.press();
  const int before = stage.program.answered;
  stage.program.height_m -= 1e-4;
  stage.loop.tick(1);
  CHECK(stage.program.exerted_n == Approx(3.0).epsilon(0.01));
  stage.loop.tick(1);
  CHECK(stage.program.exerted_n == Approx(3.3).epsilon(0.01));
  CHECK(stage.program.answered == before + 2);
}

TEST_CASE(
    "a position that stands still because no sample is new ends the trial in 5 ms, at any rate",
    "[device][safety][remote]") {
  const int rate_hz = GENERATE(500, 1000, 4000);
  device::SampleCheck samples{0.005, 1000.0};
  const double dt_s = 1.0 / rate_hz;
  int ticks = 0;
  REQUIRE(samples.judge({7, 0.0}, dt_s) == TickFault::none);
  while (samples.judge({7, 0.0}, dt_s) == TickFault::none) {
    ++ticks;
  }
  CHECK(ticks * dt_s == Approx(0.005).margin(1.01 * dt_s));
}

TEST_CASE("a device slower than the loop is no frozen one, and its velocity is that of its samples",
          "[device][remote]") {
  device::VelocityEstimate velocity;
  device::SampleCheck samples{0.005, 500.0};
  for (std::uint64_t tick = 0; tick < 200; ++tick) {  // at 1 kHz
    REQUIRE(samples.judge({tick / 2, 0.001}, 1e-3) == TickFault::none);
    if (tick % 2 == 0) {
      CHECK(samples.is_new());
      velocity.take(Vec3{0.0, 1e-4 * static_cast<double>(tick), 0.0}, 2e-3);
    }
  }
  CHECK(velocity.velocity_m_s().y() == Approx(0.1).epsilon(1e-3));
}

TEST_CASE("a force that is reported up to 20 ms late is believed at any rate, 50 ms late at none",
          "[device][safety][remote]") {
  const double rate_hz = GENERATE(500.0, 1000.0, 4000.0, 8000.0);
  const auto [lag_s, is_honest] = GENERATE(table<double, bool>(
      {{0.0, true}, {0.005, true}, {0.015, true}, {0.02, true}, {0.05, false}}));
  CAPTURE(rate_hz, lag_s);
  // taps of 60 ms every 200 ms, with a vibration that pulls, too
  const auto force_at = [](double t_s) -> core::Vec3 {
    const double in_tap_s = std::fmod(t_s, 0.2);
    if (t_s < 0.0 || in_tap_s > 0.06) {
      return core::Vec3::Zero();
    }
    const double vibration =
        std::exp(-20.0 * in_tap_s) * std::sin(2.0 * std::numbers::pi * 120.0 * in_tap_s);
    return {0.0, 2.0 * std::sin(std::numbers::pi * in_tap_s / 0.06) + 3.0 * vibration, 0.0};
  };
  device::ExertedForce exerted;
  bool is_believed = true;
  for (int tick = 0; tick < static_cast<int>(2.0 * rate_hz) && is_believed; ++tick) {
    const double t_s = tick / rate_hz;
    is_believed =
        exerted.judge(force_at(t_s), force_at(t_s - lag_s), 1.0 / rate_hz) == TickFault::none;
  }
  CHECK(is_believed == is_honest);
}

TEST_CASE("a velocity that is not the change of position ends the trial; one that lags does not",
          "[device][safety][remote]") {
  const auto [scale, lag_ticks, fault] =
      GENERATE(table<double, int, TickFault>({{1.0, 0, TickFault::none},
                                              {1.0, 25, TickFault::none},
                                              {0.0, 0, TickFault::velocity_wrong},
                                              {-1.0, 0, TickFault::velocity_wrong},
                                              {3.0, 0, TickFault::velocity_wrong}}));
  CAPTURE(scale, lag_ticks);
  Stage stage{GENERATE(1, 2, 3)};
  const auto moves = [&](int tick) {  // to and fro in 0.4 s, 0.06 m/s at most
    const double phase = 2.0 * std::numbers::pi * tick / 400.0;
    return std::pair{0.01 + 0.004 * (1.0 - std::cos(phase)),
                     0.004 * std::sin(phase) * 2.0 * std::numbers::pi / 0.4};
  };
  for (int tick = 0; tick < 4000; ++tick) {
    stage.program.height_m = moves(tick).first;
    stage.program.velocity_m_s = scale * moves(tick - lag_ticks).second;
    stage.loop.tick(1);
  }
  CHECK(stage.loop.loop->report().stopped_by == fault);
}

TEST_CASE(
    "a position that stands still to the bit under force ends the trial; one at rest does not",
    "[device][safety][remote]") {
  const bool is_alive = GENERATE(true, false);
  Stage stage{GENERATE(1, 2, 3)};
  stage.press();
  stage.program.tremor_m = is_alive ? 1e-9 : 0.0;
  const std::int64_t before = stage.loop.loop->report().ticks;
  for (int tick = 0; tick < 20'000; ++tick) {
    stage.loop.tick(1);
  }
  const device::LoopReport& report = stage.loop.loop->report();
  CHECK(report.stopped_by == (is_alive ? TickFault::none : TickFault::position_frozen));
  CHECK(static_cast<double>(report.ticks - before) == Approx(is_alive ? 20'000 : 3000).margin(2));
}

TEST_CASE(
    "a program that reports a released force in the first replies of a trial is believed for 30 ms "
    "at any rate, and one that does so in every reply is not",
    "[device][safety][remote]") {
  for (const double rate_hz : {500.0, 1000.0, 8000.0}) {
    Stage at_this_rate;
    at_this_rate.program.trouble = RemoteTrouble::releases;
    core::HandState state;
    int replies = 0;
    while (at_this_rate.hand.read(state, 1.0 / rate_hz) == TickFault::none) {
      ++replies;
    }
    CHECK(replies == Approx(0.03 * rate_hz).margin(1.01));
  }
  Stage stage;
  stage.program.trouble = RemoteTrouble::releases;
  CHECK(stage.hand.release_after(std::chrono::milliseconds{20}) ==
        device::RemoteHand::Release::always_reported);
  stage.loop.tick(200);
  CHECK(stage.loop.loop->report().stopped_by == TickFault::force_released);
}

TEST_CASE("another device that answers from the next trial on gets no force",
          "[device][safety][remote]") {
  Stage stage{3};
  CHECK(stage.hand.begin() == TickFault::none);
  SECTION("another serial number") {
    stage.program.introduction.serial_number = {"M2"};
    stage.loop.tick(100);
    CHECK(stage.loop.loop->report().stopped_by == TickFault::device_gone);
    CHECK(stage.program.exerted_n == 0.0);
  }
  SECTION("no answer") {
    stage.program.trouble = RemoteTrouble::deaf;
    CHECK(stage.hand.begin() == TickFault::no_reply);
  }
}

TEST_CASE("a stop that a later reply contradicts is not confirmed", "[device][safety][remote]") {
  Stage stage;
  CHECK(stage.hand.zero_force() == device::StopOutcome::confirmed);
  stage.program.trouble = RemoteTrouble::overload;
  CHECK(stage.hand.zero_force() == device::StopOutcome::unconfirmed);
}

TEST_CASE(
    "a stop is confirmed by two samples that the device took after it was sent zero force, not by "
    "replies that repeat a sample or come out of a queue",
    "[device][safety][remote]") {
  const auto [samples_left, age_s, outcome] = GENERATE(
      table<int, double, device::StopOutcome>({{0, 1e-4, device::StopOutcome::unconfirmed},
                                               {2, 1e-4, device::StopOutcome::unconfirmed},
                                               {3, 1e-4, device::StopOutcome::confirmed},
                                               {1000, 1e-4, device::StopOutcome::confirmed},
                                               {1000, 0.2, device::StopOutcome::unconfirmed}}));
  CAPTURE(samples_left, age_s);
  const double rate_hz = GENERATE(20.0, 1000.0);
  Stage stage{3, rate_hz};
  stage.program.samples_left = samples_left;
  stage.program.age_s = age_s;
  CHECK(stage.hand.zero_force() == outcome);
}

TEST_CASE("a stop is confirmed though the device measures its force coarsely or late",
          "[device][safety][remote]") {
  for (const RemoteTrouble trouble : {RemoteTrouble::coarse, RemoteTrouble::none}) {
    CAPTURE(static_cast<int>(trouble));
    Stage stage;
    stage.press();
    stage.program.trouble = trouble;
    stage.program.gauge_lag_s = 0.01;
    for (int i = 0; i < 20; ++i) {
      REQUIRE(stage.hand.zero_force() == device::StopOutcome::confirmed);
    }
  }
}

TEST_CASE("a program that replies in another format is told from one that is mute or is not there",
          "[device][remote]") {
  for (const auto& [trouble, said] :
       {std::pair{RemoteTrouble::short_reply, "but not as version 1, 2 or 3"},
        std::pair{RemoteTrouble::mute, "nobody answers"},
        std::pair{RemoteTrouble::gone, "nobody answers"}}) {
    auto program = std::make_unique<RemoteProgram>();
    program->trouble = trouble;
    CHECK_THROWS_WITH((device::RemoteHand{40'000, {max_reply}, std::move(program)}),
                      Contains(said));
  }
}
