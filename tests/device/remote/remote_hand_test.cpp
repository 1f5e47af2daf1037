#include "device/remote/remote_hand.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstring>
#include <deque>
#include <limits>
#include <numbers>
#include <vector>

#include "core/random/rng.hpp"
#include "device/hand/prescribed_hand.hpp"
#include "device/remote/packets.hpp"
#include "support/catch.hpp"
#include "support/example_bridge.hpp"
#include "support/staged_loop.hpp"
using namespace tapstudy;
using core::TickFault;
using core::Vec3;

using testing::ExampleBridge;
using testing::free_port;

namespace {
// The example runs in real time: a machine that is busy elsewhere may keep either program from it
// for long, but a reply comes in the end.
constexpr std::chrono::milliseconds unhurried{20'000};

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
  const auto bytes =
      device::encoded({device::RequestKind::no_reply, 0x01020304U, Vec3{0.0, -2.0, 1.0}});
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

TEST_CASE(
    "a socket of the loopback carries datagrams whole, is silent until the deadline, and tells of "
    "a "
    "closed port",
    "[device][remote]") {
  const int other = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  auto generic = std::bit_cast<sockaddr>(address);
  socklen_t size = sizeof generic;
  REQUIRE(bind(other, &generic, size) == 0);
  REQUIRE(getsockname(other, &generic, &size) == 0);
  const auto pipe = device::open_udp_pipe(ntohs(std::bit_cast<sockaddr_in>(generic).sin_port));
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

TEST_CASE("the bridge's finger moves under the force it is sent", "[device][remote]") {
  const std::uint16_t port = free_port();
  ExampleBridge bridge{port};
  device::RemoteHand hand{port, unhurried};
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

namespace {
// Another program on this machine that would like to move the device.
class RogueSender {
 public:
  explicit RogueSender(std::uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const auto generic = std::bit_cast<sockaddr>(address);
    REQUIRE(connect(socket_, &generic, sizeof generic) == 0);
  }
  ~RogueSender() { close(socket_); }
  RogueSender(const RogueSender&) = delete;
  RogueSender& operator=(const RogueSender&) = delete;
  RogueSender(RogueSender&&) = delete;
  RogueSender& operator=(RogueSender&&) = delete;
  void send(const Vec3& force_n) {
    const auto bytes = device::encoded({device::RequestKind::no_reply, 4'000'000'000U, force_n});
    static_cast<void>(::send(socket_, bytes.data(), bytes.size(), 0));
    static_cast<void>(::send(socket_, "nonsense", 8, 0));
  }
  void ask(std::uint32_t number, const Vec3& force_n) {
    const auto bytes = device::encoded({device::RequestKind::reply, number, force_n});
    static_cast<void>(::send(socket_, bytes.data(), bytes.size(), 0));
  }
  std::optional<device::RemoteReply> next_reply(std::chrono::milliseconds patience = unhurried) {
    pollfd waiting{socket_, POLLIN, 0};
    std::array<std::uint8_t, 128> reply{};
    poll(&waiting, 1, static_cast<int>(patience.count()));
    const ssize_t count = recv(socket_, reply.data(), reply.size(), MSG_DONTWAIT);
    return count < 0
               ? std::nullopt
               : device::decoded_reply(std::span{reply}.first(static_cast<std::size_t>(count)));
  }

 private:
  int socket_{socket(AF_INET, SOCK_DGRAM, 0)};
};
}  // namespace

TEST_CASE("the example bridge obeys one sender, and never more force than the device may exert",
          "[device][remote][safety]") {
  const std::uint16_t port = free_port();
  const ExampleBridge bridge{port};
  device::RemoteHand hand{port, unhurried};
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
  const auto first = sender.next_reply();  // replies come in the order of the requests
  const auto second = sender.next_reply();
  REQUIRE((first && second));
  CHECK(first->exerted_n == Vec3{1.0, 0.0, 0.0});
  CHECK(second->number == last + 3);
  CHECK(second->exerted_n == Vec3{2.0, 0.0, 0.0});
}

TEST_CASE("the example bridge lets go of the force when nobody asks", "[device][remote][safety]") {
  const std::uint16_t port = free_port();
  const ExampleBridge bridge{port};
  device::RemoteHand hand{port, unhurried};
  CHECK(hand.release_after(std::chrono::milliseconds{150}) ==
        device::RemoteHand::Release::released);
}

TEST_CASE("a remote stop is confirmed by a reply, or it is not a stop",
          "[device][remote][safety]") {
  const std::uint16_t port = free_port();
  ExampleBridge bridge{port};
  device::RemoteHand hand{port, unhurried};
  CHECK(hand.emergency_stop() == device::StopOutcome::confirmed);
  bridge.end();
  CHECK(hand.emergency_stop() == device::StopOutcome::unconfirmed);
}

// What every fault of a remote device does in every state of the loop.
using device::DatagramOutcome;
using device::Nanoseconds;
using namespace std::chrono_literals;

namespace {
constexpr Nanoseconds slow_reply = 20'000'000;
constexpr auto max_reply = 5ms;

enum class Trouble {
  none,
  deaf,
  mute,
  slow,
  short_reply,
  old_number,
  not_a_number,
  jump,
  no_power,
  overload,     // exerts far more than it was sent
  limp,         // exerts nothing
  reversed,     // exerts the force the other way round
  sideways,     // exerts it along another axis
  half_known,   // tells of one axis of the force only
  falls_back,   // to version 1
  coarse,       // its gauge is noisy
  late,         // its gauge is 10 replies late
  releases,     // as after a silence
  every_other,  // request is answered
  gone
};

// A program that drives a device: a finger held by a muscle, pushed by the force. Time passes only
// while it is waited for; a datagram takes none, and datagrams are obeyed one after the other.
class MockProgram final : public device::DatagramPipe {
 public:
  Trouble trouble{Trouble::none};
  bool is_version_2{false};
  double height_m{0.01};
  double velocity_m_s{0.0};
  double exerted_n{0.0};
  int forces_since_trouble{0};

  Nanoseconds now() noexcept override { return now_; }
  void wait_until(Nanoseconds moment) noexcept override {
    while (!requests_.empty() && free_at_ <= moment) {
      now_ = std::max(now_, free_at_);
      const Request request = requests_.front();
      requests_.pop_front();
      if (trouble != Trouble::deaf) {
        obey(request);
      }
    }
    now_ = std::max(now_, moment);
  }
  // As the loopback does: a closed port is told of by what follows the first datagram.
  DatagramOutcome send(std::span<const std::uint8_t> out) noexcept override {
    if (trouble == Trouble::gone) {
      return std::exchange(is_refused_, true) ? DatagramOutcome::gone : DatagramOutcome::ok;
    }
    std::ranges::copy(out, requests_.emplace_back().begin());
    wait_until(now_);
    return DatagramOutcome::ok;
  }
  device::ReceivedDatagram receive(std::span<std::uint8_t> in,
                                   Nanoseconds deadline) noexcept override {
    if (std::exchange(is_refused_, false)) {
      return {DatagramOutcome::gone, 0};
    }
    while (now_ < deadline) {
      if (!replies_.empty() && replies_.front().at <= now_) {
        const Reply reply = replies_.front();
        replies_.pop_front();
        const std::size_t length = std::min(in.size(), reply.length);
        std::copy_n(reply.bytes.begin(), length, in.begin());
        return {DatagramOutcome::ok, length};
      }
      const Nanoseconds next_reply = replies_.empty() ? deadline : replies_.front().at;
      const Nanoseconds next_request = requests_.empty() ? deadline : free_at_;
      wait_until(std::min({deadline, next_reply, next_request}));
    }
    return {DatagramOutcome::timed_out, 0};
  }

 private:
  using Request = std::array<std::uint8_t, 36>;
  struct Reply {
    Nanoseconds at;
    std::array<std::uint8_t, 88> bytes;
    std::size_t length;
  };

  void obey(const Request& request) {
    double force_n = 0.0;
    std::memcpy(&force_n, request.data() + 20, sizeof force_n);
    exerted_n = force_n;
    forces_since_trouble += trouble != Trouble::none && force_n > 0.0 ? 1 : 0;
    const bool is_left_out =
        trouble == Trouble::every_other && request[4] == 1 && ++asked_ % 2 == 0;
    if (request[4] == 1 && trouble != Trouble::mute && !is_left_out) {
      free_at_ = now_ + (trouble == Trouble::slow ? slow_reply : 0);
      const std::size_t length = trouble == Trouble::short_reply ? 30 : tells_of_force() ? 88 : 60;
      replies_.push_back({free_at_, reply_to(request), length});
    }
  }
  bool tells_of_force() const {
    return (is_version_2 && trouble != Trouble::falls_back) || trouble == Trouble::no_power ||
           trouble == Trouble::overload;
  }
  std::array<std::uint8_t, 88> reply_to(const Request& request) {
    std::array<std::uint8_t, 88> reply{'T', 'A', 'P', 'R', 1};
    reply[4] = tells_of_force() ? 2 : 1;
    const std::uint32_t on = trouble == Trouble::no_power ? 0 : device::motors_on;
    const std::uint32_t status =
        on | (trouble == Trouble::releases ? device::force_was_released : 0);
    std::memcpy(reply.data() + 60, &status, sizeof status);
    const double told_n = measured_n();
    const bool is_sideways = trouble == Trouble::sideways;
    const std::array<double, 2> told_xy_n{is_sideways ? told_n
                                          : trouble == Trouble::half_known
                                              ? std::numeric_limits<double>::quiet_NaN()
                                              : 0.0,
                                          is_sideways ? 0.0 : told_n};
    std::memcpy(reply.data() + 64, told_xy_n.data(), sizeof told_xy_n);
    const double velocity = velocity_m_s;
    std::memcpy(reply.data() + 44, &velocity, sizeof velocity);
    std::copy_n(request.begin() + 8, 4, reply.begin() + 8);
    reply[8] = static_cast<std::uint8_t>(reply[8] - (trouble == Trouble::old_number ? 1 : 0));
    const double y_m = trouble == Trouble::not_a_number ? std::numeric_limits<double>::quiet_NaN()
                       : trouble == Trouble::jump       ? 0.3
                                                        : height_m;
    std::memcpy(reply.data() + 20, &y_m, sizeof y_m);
    return reply;
  }

  double measured_n() {
    gauge_n_.push_back(exerted_n);
    switch (trouble) {
      case Trouble::overload:
        return 80.0;
      case Trouble::limp:
        return 0.0;
      case Trouble::reversed:
        return -exerted_n;
      case Trouble::coarse:
        return exerted_n + 0.1 * rng_.normal();
      case Trouble::late:
        return gauge_n_.size() > 10 ? gauge_n_[gauge_n_.size() - 11] : 0.0;
      default:
        return exerted_n;
    }
  }

  core::Rng rng_{1};
  std::vector<double> gauge_n_;
  int asked_{0};
  Nanoseconds now_{0};
  Nanoseconds free_at_{0};
  std::deque<Request> requests_;
  std::deque<Reply> replies_;
  bool is_refused_{false};
};

struct Stage {
  std::unique_ptr<MockProgram> owned = std::make_unique<MockProgram>();
  MockProgram& program{*owned};
  device::RemoteHand hand{40'000, max_reply, std::move(owned)};
  testing::StagedLoop loop{hand};

  void arm() { loop.tick(5); }
  void press() {
    loop.tick(200);
    for (int i = 1; i <= 100; ++i) {
      program.height_m = 0.01 - 1.1e-4 * i;  // 1 mm deep, slowly enough
      loop.tick(1);
    }
    REQUIRE(program.exerted_n == Approx(3.0).epsilon(0.01));
  }
};

struct Fault {
  const char* name;
  Trouble trouble;
  std::vector<TickFault> seen_as;
  bool is_stop_confirmed;
};
const std::vector<Fault> all_faults{
    {"hears nothing", Trouble::deaf, {TickFault::no_reply}, false},
    {"hears, and is mute", Trouble::mute, {TickFault::no_reply}, false},
    {"replies after 20 ms", Trouble::slow, {TickFault::no_reply}, false},
    {"half a reply", Trouble::short_reply, {TickFault::bad_reply}, false},
    {"an old reply", Trouble::old_number, {TickFault::no_reply}, false},
    {"position is NaN", Trouble::not_a_number, {TickFault::non_finite_force}, true},
    {"position jumps", Trouble::jump, {TickFault::too_fast, TickFault::outside_workspace}, true},
    {"motors are off", Trouble::no_power, {TickFault::amplifier_off}, true},
    {"exerts 80 N", Trouble::overload, {TickFault::force_not_followed}, false},
    {"has ended", Trouble::gone, {TickFault::device_gone, TickFault::no_reply}, false}};

struct State {
  const char* name;
  void (Stage::*reach)();
  TickFault (testing::StagedLoop::*go_on)();
};
}  // namespace

TEST_CASE("the fault matrix of a remote device: no force is sent once the fault is found",
          "[device][safety][remote]") {
  const std::vector<State> states{
      {"armed", &Stage::arm, &testing::StagedLoop::go_on},
      {"rendering", &Stage::press, &testing::StagedLoop::go_on},
      {"stopping", &Stage::press, &testing::StagedLoop::go_on_and_stop}};
  testing::print_fault_heading("remote device");
  for (const Fault& fault : all_faults) {
    for (const State& state : states) {
      CAPTURE(fault.name, state.name);
      Stage stage;
      (stage.*state.reach)();
      const std::int64_t before = stage.loop.loop->report().ticks;
      const Nanoseconds began = stage.program.now();
      stage.program.trouble = fault.trouble;
      const TickFault seen = (stage.loop.*state.go_on)();
      const Nanoseconds took = stage.program.now() - began;
      stage.program.wait_until(stage.program.now() + 1'000'000'000);
      const auto& report = stage.loop.loop->report();
      const std::int64_t ticks = report.ticks - before;
      const bool is_confirmed = report.stop == device::StopOutcome::confirmed;
      stage.loop.tick(20);
      const bool is_latched = report.ticks == before + ticks;
      const std::string stored = core::to_text(stage.loop.last_sample().fault);
      testing::print({fault.name, state.name, ticks, is_latched, is_confirmed, stored});
      CAPTURE(core::to_text(seen));
      CHECK(std::ranges::count(fault.seen_as, seen) == 1);
      CHECK(stored == core::to_text(seen));
      CHECK(is_latched);
      CHECK(is_confirmed == fault.is_stop_confirmed);
      CHECK(ticks <= 1 + device::max_missed_replies);
      CHECK(took <= (ticks + device::zero_force_packets) * Nanoseconds{max_reply / 1ns} +
                        30'000'000);  // and a millisecond before each further request for zero
      CHECK(stage.program.forces_since_trouble <= 2 * ticks);
      // whoever hears us exerts nothing at the end
      const bool hears = fault.trouble != Trouble::deaf && fault.trouble != Trouble::gone;
      CHECK((!hears || stage.program.exerted_n == 0.0));
    }
  }
}

TEST_CASE(
    "a remote device that does not exert the force, releases it, or misses half of the replies "
    "ends the trial",
    "[device][safety][remote]") {
  const std::vector<std::pair<Trouble, TickFault>> troubles{
      {Trouble::limp, TickFault::force_not_followed},
      {Trouble::reversed, TickFault::force_not_followed},
      {Trouble::sideways, TickFault::force_not_followed},
      {Trouble::half_known, TickFault::bad_reply},
      {Trouble::falls_back, TickFault::bad_reply},
      {Trouble::releases, TickFault::force_released},
      {Trouble::every_other, TickFault::no_reply}};
  for (const auto& [trouble, fault] : troubles) {
    CAPTURE(core::to_text(fault));
    Stage stage;
    stage.program.is_version_2 = true;
    stage.press();
    const std::int64_t before = stage.loop.loop->report().ticks;
    stage.program.trouble = trouble;
    stage.loop.tick(100);
    CHECK(stage.loop.loop->report().stopped_by == fault);
    CHECK(stage.loop.loop->report().ticks - before < 80);
  }
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
  Stage stage;
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
  Stage stage;
  stage.program.is_version_2 = GENERATE(false, true);
  stage.press();
  const std::int64_t before = stage.loop.loop->report().ticks;
  for (int tick = 0; tick < 20'000; ++tick) {
    stage.program.height_m += is_alive ? 1e-9 * (tick % 2 == 0 ? 1 : -1) : 0.0;
    stage.loop.tick(1);
  }
  const device::LoopReport& report = stage.loop.loop->report();
  CHECK(report.stopped_by == (is_alive ? TickFault::none : TickFault::position_frozen));
  CHECK(static_cast<double>(report.ticks - before) == Approx(is_alive ? 20'000 : 3000).margin(2));
}

TEST_CASE("a program that reports a released force in every reply is not believed",
          "[device][safety][remote]") {
  Stage stage;
  stage.program.is_version_2 = true;
  stage.program.trouble = Trouble::releases;
  CHECK(stage.hand.release_after(std::chrono::milliseconds{20}) ==
        device::RemoteHand::Release::always_reported);
  stage.loop.tick(200);
  CHECK(stage.loop.loop->report().stopped_by == TickFault::force_released);
}

TEST_CASE("a stop that a later reply contradicts is not confirmed", "[device][safety][remote]") {
  Stage stage;
  stage.program.is_version_2 = true;
  CHECK(stage.hand.zero_force() == device::StopOutcome::confirmed);
  stage.program.trouble = Trouble::overload;
  CHECK(stage.hand.zero_force() == device::StopOutcome::unconfirmed);
}

TEST_CASE("a stop is confirmed though the device measures its force coarsely or late",
          "[device][safety][remote]") {
  for (const Trouble trouble : {Trouble::coarse, Trouble::late}) {
    CAPTURE(static_cast<int>(trouble));
    Stage stage;
    stage.program.is_version_2 = true;
    stage.press();
    stage.program.trouble = trouble;
    for (int i = 0; i < 20; ++i) {
      REQUIRE(stage.hand.zero_force() == device::StopOutcome::confirmed);
    }
  }
}

TEST_CASE("a program that replies in another format is told from one that is mute or is not there",
          "[device][remote]") {
  for (const auto& [trouble, said] :
       {std::pair{Trouble::short_reply, "but not as version 1 or 2"},
        std::pair{Trouble::mute, "nobody answers"}, std::pair{Trouble::gone, "nobody answers"}}) {
    auto program = std::make_unique<MockProgram>();
    program->trouble = trouble;
    CHECK_THROWS_WITH((device::RemoteHand{40'000, max_reply, std::move(program)}), Contains(said));
  }
}
