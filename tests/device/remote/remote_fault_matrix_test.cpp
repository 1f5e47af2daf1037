// What every fault of a remote device does in every state of the loop.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <deque>
#include <limits>
#include <numbers>
#include <vector>

#include "core/rng.hpp"
#include "device/remote/packets.hpp"
#include "device/remote/remote_hand.hpp"
#include "support/catch.hpp"
#include "support/staged_loop.hpp"
using namespace tapstudy;
using core::TickFault;
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
    stage.program.height_m = moves(tick).first;
    stage.program.velocity_m_s = scale * moves(tick - lag_ticks).second;
    stage.loop.tick(1);
  }
  CHECK(stage.loop.loop->report().stopped_by == fault);
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
