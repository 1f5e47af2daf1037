// What every fault of a remote device does in every state of the loop.
#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstring>
#include <limits>
#include <numbers>
#include <thread>
#include <vector>

#include "core/rng.hpp"
#include "device/remote/packets.hpp"
#include "device/remote/remote_hand.hpp"
#include "support/catch.hpp"
#include "support/staged_loop.hpp"
using namespace tapstudy;
using core::TickFault;

namespace {
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

// A program that drives a device: a finger held by a muscle, pushed by the force.
class MockProgram {
 public:
  MockProgram() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    auto generic = std::bit_cast<sockaddr>(address);
    REQUIRE(bind(socket_, &generic, sizeof generic) == 0);
    socklen_t size = sizeof generic;
    REQUIRE(getsockname(socket_, &generic, &size) == 0);
    port = ntohs(std::bit_cast<sockaddr_in>(generic).sin_port);
    thread_ = std::jthread{[this](const std::stop_token& stop) { serve(stop); }};
  }
  std::uint16_t port{};
  std::atomic<Trouble> trouble{Trouble::none};
  std::atomic<bool> is_version_2{false};
  std::atomic<double> height_m{0.01};
  std::atomic<double> velocity_m_s{0.0};
  std::atomic<double> exerted_n{0.0};
  std::atomic<int> forces_since_trouble{0};

 private:
  void serve(const std::stop_token& stop) {
    while (!stop.stop_requested() && trouble != Trouble::gone) {
      std::array<std::uint8_t, 64> request{};
      sockaddr from{};
      socklen_t size = sizeof from;
      pollfd waiting{socket_, POLLIN, 0};
      if (poll(&waiting, 1, 1) == 1 &&
          recvfrom(socket_, request.data(), request.size(), 0, &from, &size) == 36) {
        obey(request, from, size);
      }
    }
    close(socket_);
  }
  void obey(const std::array<std::uint8_t, 64>& request, const sockaddr& from, socklen_t size) {
    if (trouble == Trouble::deaf) {
      return;
    }
    double force_n = 0.0;
    std::memcpy(&force_n, request.data() + 20, sizeof force_n);
    exerted_n = force_n;
    forces_since_trouble += trouble != Trouble::none && force_n > 0.0 ? 1 : 0;
    const bool is_left_out =
        trouble == Trouble::every_other && request[4] == 1 && ++requests_ % 2 == 0;
    if (request[4] == 1 && trouble != Trouble::mute && !is_left_out) {
      usleep(trouble == Trouble::slow ? 20'000 : 0);
      const auto reply = reply_to(request);
      const std::size_t length = trouble == Trouble::short_reply ? 30 : tells_of_force() ? 88 : 60;
      static_cast<void>(sendto(socket_, reply.data(), length, 0, &from, size));
    }
  }
  bool tells_of_force() const {
    return (is_version_2 && trouble != Trouble::falls_back) || trouble == Trouble::no_power ||
           trouble == Trouble::overload;
  }
  std::array<std::uint8_t, 88> reply_to(const std::array<std::uint8_t, 64>& request) {
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
                                                        : height_m.load();
    std::memcpy(reply.data() + 20, &y_m, sizeof y_m);
    return reply;
  }

  double measured_n() {
    gauge_n_.push_back(exerted_n);
    switch (trouble.load()) {
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
  int requests_{0};
  int socket_{socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  std::jthread thread_;
};

struct Stage : MockProgram {
  device::RemoteHand hand{port, std::chrono::milliseconds{5}};
  testing::StagedLoop loop{hand};

  void arm() { loop.tick(5); }
  void press() {
    loop.tick(200);
    for (int i = 1; i <= 100; ++i) {
      height_m = 0.01 - 1.1e-4 * i;  // 1 mm deep, slowly enough
      loop.tick(1);
    }
    usleep(3000);  // the last force is under way
    REQUIRE(exerted_n == Approx(3.0).epsilon(0.01));
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
      stage.trouble = fault.trouble;
      usleep(3000);
      const TickFault seen = (stage.loop.*state.go_on)();
      usleep(30'000);
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
      CHECK(stage.forces_since_trouble <= 2 * ticks);
      // whoever hears us exerts nothing at the end
      const bool hears = fault.trouble != Trouble::deaf && fault.trouble != Trouble::gone;
      CHECK((!hears || stage.exerted_n == 0.0));
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
    stage.is_version_2 = true;
    stage.press();
    const std::int64_t before = stage.loop.loop->report().ticks;
    stage.trouble = trouble;
    stage.loop.tick(100);
    CHECK(stage.loop.loop->report().stopped_by == fault);
    CHECK(stage.loop.loop->report().ticks - before < 60);
  }
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
    stage.height_m = moves(tick).first;
    stage.velocity_m_s = scale * moves(tick - lag_ticks).second;
    stage.loop.tick(1);
  }
  CHECK(stage.loop.loop->report().stopped_by == fault);
}

TEST_CASE("a program that reports a released force in every reply is not believed",
          "[device][safety][remote]") {
  Stage stage;
  stage.is_version_2 = true;
  stage.trouble = Trouble::releases;
  CHECK(stage.hand.release_after(std::chrono::milliseconds{20}) ==
        device::RemoteHand::Release::always_reported);
  stage.loop.tick(200);
  CHECK(stage.loop.loop->report().stopped_by == TickFault::force_released);
}

TEST_CASE("a stop that a later reply contradicts is not confirmed", "[device][safety][remote]") {
  Stage stage;
  stage.is_version_2 = true;
  CHECK(stage.hand.zero_force() == device::StopOutcome::confirmed);
  stage.trouble = Trouble::overload;
  CHECK(stage.hand.zero_force() == device::StopOutcome::unconfirmed);
}

TEST_CASE("a stop is confirmed though the device measures its force coarsely or late",
          "[device][safety][remote]") {
  for (const Trouble trouble : {Trouble::coarse, Trouble::late}) {
    CAPTURE(static_cast<int>(trouble));
    Stage stage;
    stage.is_version_2 = true;
    stage.press();
    stage.trouble = trouble;
    for (int i = 0; i < 20; ++i) {
      REQUIRE(stage.hand.zero_force() == device::StopOutcome::confirmed);
    }
  }
}

TEST_CASE("a program that replies in another format is told from one that is not there",
          "[device][remote]") {
  MockProgram program;
  program.trouble = Trouble::short_reply;
  CHECK_THROWS_WITH((device::RemoteHand{program.port, std::chrono::milliseconds{5}}),
                    Contains("but not as version 1 or 2"));
}
