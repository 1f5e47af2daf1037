// The example bridges and their devices in every trouble, in one table, as programs of their own. A
// bridge is a row: its device, which can be hung, frozen and unplugged. Time is real: what takes
// long because the machine is busy is waited for.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "device/remote/remote_hand.hpp"
#include "support/bridges/mock_board.hpp"
#include "support/bridges/paced_pipe.hpp"
#include "support/bridges/rogue_sender.hpp"
#include "support/bridges/service_stand_in.hpp"
#include "support/catch.hpp"
#include "support/dhd/stand_in.hpp"
#include "support/example_bridge.hpp"
#include "support/mapped_stand_in.hpp"
#include "support/openhaptics/stand_in.hpp"
#include "support/other_tapstudy.hpp"
#include "support/staged_loop.hpp"
using namespace tapstudy;
using core::TickFault;
using core::Vec3;
using device::StopOutcome;
using testing::max_sample_age_s;
using testing::OtherTapstudy;
using testing::press;
using testing::wait_until;

namespace {
constexpr double pressed_n = 2.0;

// The device behind a bridge. Its hand trembles, until it is frozen.
class BridgedDevice {
 public:
  virtual ~BridgedDevice() = default;
  virtual std::vector<std::string> command() = 0;  // of the bridge, without the port
  virtual double max_force_n() const = 0;
  virtual double exerted_n() = 0;  // upwards, now
  // Of the forces that it was told to exert since the last call.
  virtual double largest_n() = 0;
  virtual void hang() = 0;  // no sample is new
  virtual void freeze() = 0;
  virtual void unplug() = 0;
  virtual void lose_position() = 0;  // it is not a number
  virtual void answer_every_other() = 0;
  // False where it cannot matter; why.
  virtual bool plug_in_second() { return false; }
  virtual bool has_forced_second() { return false; }
  virtual std::string why_no_second() const { return "every call names the device it is for"; }
  // A device that numbers its samples, or measures its force.
  virtual testing::MockBoard* numbering() { return nullptr; }
  // Who lets go where the bridge, or the device's own program, is killed or hangs; empty: the
  // device.
  virtual std::string without_bridge() const { return {}; }
  virtual std::string when_hung() const { return {}; }
};

class SerialBoardRow final : public BridgedDevice {
 public:
  SerialBoardRow() { board_.tremble(); }
  std::vector<std::string> command() override {
    return {testing::serial_board_program(), board_.path()};
  }
  double max_force_n() const override { return 3.0; }
  double exerted_n() override { return static_cast<double>(board_.exerted_n()); }
  double largest_n() override { return static_cast<double>(board_.largest_force_n()); }
  void hang() override { board_.fall_silent(); }
  void freeze() override { board_.stand_still(); }
  void unplug() override { board_.unplug(); }
  void lose_position() override { board_.lose_position(); }
  void answer_every_other() override { board_.answer_every_other(); }
  testing::MockBoard* numbering() override { return &board_; }
  std::string why_no_second() const override { return "its port is opened once, by its path"; }

 private:
  testing::MockBoard board_;
};

// Its watchdog is the device's own.
class DhdRow final : public BridgedDevice {
 public:
  DhdRow() { device().tremor_m = 1e-4; }
  std::vector<std::string> command() override {
    return {testing::dhd_program(), "4.0", "3000", "0.05"};
  }
  double max_force_n() const override { return 4.0; }
  double exerted_n() override {
    const std::int64_t now_ns = std::chrono::steady_clock::now().time_since_epoch().count();
    const bool is_released = now_ns - device().asked_at_ns > 125'000LL * device().watchdog;
    return is_released || !device().is_force_enabled ? 0.0 : device().force_n[2].load();
  }
  double largest_n() override { return device().largest_n.exchange(0.0); }
  void hang() override { device().is_hung = true; }
  void freeze() override { device().tremor_m = 0.0; }
  void unplug() override { device().is_gone = true; }
  void lose_position() override { device().is_lost = true; }
  void answer_every_other() override { device().is_every_other = true; }

 private:
  testing::DhdStandIn& device() { return shared_.device(); }
  testing::MappedStandIn<testing::DhdStandIn> shared_;
};

class OpenHapticsRow final : public BridgedDevice {
 public:
  OpenHapticsRow() { device().tremor_m = 1e-4; }
  std::vector<std::string> command() override { return {testing::openhaptics_program()}; }
  double max_force_n() const override { return 3.3; }
  double exerted_n() override { return device().force_n[1]; }
  double largest_n() override { return device().largest_n.exchange(0.0); }
  void hang() override { device().is_hung = true; }
  void freeze() override { device().tremor_m = 0.0; }
  void unplug() override { device().is_gone = true; }
  void lose_position() override { device().is_lost = true; }
  void answer_every_other() override { device().is_every_other = true; }
  std::string without_bridge() const override { return "the vendor's driver must let go"; }
  std::string when_hung() const override { return without_bridge(); }

 private:
  testing::OpenHapticsStandIn& device() { return shared_.device(); }
  testing::MappedStandIn<testing::OpenHapticsStandIn> shared_;
};

class Inverse3Row final : public BridgedDevice {
 public:
  Inverse3Row() { service_.tremble(); }
  std::vector<std::string> command() override { return service_.command(); }
  double max_force_n() const override { return 8.0; }
  double exerted_n() override { return is_unplugged_ ? 0.0 : service_.force_n().z(); }
  double largest_n() override { return service_.largest_force_n(); }
  void hang() override { service_.is_silent = true; }
  void freeze() override { service_.stand_still(); }
  void unplug() override {
    service_.end();
    is_unplugged_ = true;
  }
  void lose_position() override { service_.lose_position(); }
  void answer_every_other() override { service_.answer_every_other(); }
  bool plug_in_second() override {
    service_.plug_in_second();
    return true;
  }
  bool has_forced_second() override { return service_.has_forced_another(); }
  std::string without_bridge() const override { return "the vendor's service must let go"; }

 private:
  testing::ServiceStandIn service_;
  bool is_unplugged_{false};
};

void press_until(device::RemoteHand& hand, BridgedDevice& row, double force_n, double exerted_n) {
  while (std::abs(row.exerted_n() - exerted_n) > 1e-6) {
    static_cast<void>(press(hand, force_n));
  }
}

struct Bench {
  BridgedDevice& row;
  std::uint16_t port{testing::free_port()};
  testing::ExampleBridge bridge{port, row.command()};
};
// With force on.
struct Pressed : Bench {
  explicit Pressed(BridgedDevice& its_row, std::chrono::microseconds max_reply = testing::unhurried)
      : Bench{its_row}, hand{port, {max_reply, max_sample_age_s}} {
    press_until(hand, row, pressed_n, pressed_n);
  }
  device::RemoteHand hand;
};

std::string force(BridgedDevice& row) {
  Pressed pressed{row};
  press_until(pressed.hand, row, 300.0, row.max_force_n());
  CHECK(row.largest_n() <= row.max_force_n() + 1e-6);
  while (pressed.hand.zero_force() != StopOutcome::confirmed) {  // the machine may be busy
  }
  CHECK(row.exerted_n() == 0.0);
  return "as asked, at most its limit, and off when the stop is confirmed";
}

std::string tapstudy_killed(BridgedDevice& row) {
  Bench bench{row};
  OtherTapstudy other{bench.port, pressed_n};
  wait_until([&] { return row.exerted_n() == pressed_n; });
  other.end();
  wait_until([&] { return row.exerted_n() == 0.0; });
  return "force off";
}

std::string tapstudy_stopped(BridgedDevice& row) {
  Bench bench{row};
  OtherTapstudy other{bench.port, pressed_n};
  for (int i = 0; i < 2; ++i) {
    wait_until([&] { return row.exerted_n() == pressed_n; });
    other.stop();
    wait_until([&] { return row.exerted_n() == 0.0; });
    other.go_on();
  }
  return "force off, twice";
}

std::string bridge_killed(BridgedDevice& row) {
  Pressed pressed{row};
  pressed.bridge.end();
  TickFault fault = TickFault::none;
  for (int i = 0; i < 3 && fault == TickFault::none; ++i) {
    fault = press(pressed.hand, pressed_n);
  }
  CHECK(fault == TickFault::device_gone);
  CHECK(pressed.hand.emergency_stop() == StopOutcome::unconfirmed);
  CHECK_FALSE(pressed.hand.is_force_off());
  if (row.without_bridge().empty()) {
    wait_until([&] { return row.exerted_n() == 0.0; });
  }
  return fmt::format("{}, {}", core::to_text(fault),
                     row.without_bridge().empty() ? "force off" : row.without_bridge());
}

std::string bridge_stopped(BridgedDevice& row) {
  Pressed pressed{row, std::chrono::milliseconds{6}};
  pressed.bridge.stop();
  for (int i = 0; i < 5; ++i) {  // 30 ms of requests for more, which wait
    static_cast<void>(press(pressed.hand, 1.5 * pressed_n));
  }
  if (row.without_bridge().empty()) {
    wait_until([&] { return row.exerted_n() == 0.0; });
  }
  row.largest_n();
  pressed.bridge.go_on();
  while (pressed.hand.zero_force() != StopOutcome::confirmed) {
  }
  CHECK(row.largest_n() <= pressed_n);  // what it was about to send may still go
  CHECK(row.exerted_n() == 0.0);
  return fmt::format("{}; continued it exerts nothing that waited",
                     row.without_bridge().empty() ? "force off" : row.without_bridge());
}

// Once it says that its device has no motors on, and from then on, when the last sample is too old.
std::string what_is_said(device::RemoteHand& hand) {
  std::string said;
  for (const int later_ms : {0, 50}) {
    std::this_thread::sleep_for(std::chrono::milliseconds{later_ms});
    while (press(hand, pressed_n) != TickFault::amplifier_off) {
    }
    said = hand.text();
    CHECK_FALSE(said.empty());
  }
  return said;
}

std::string found(BridgedDevice& row, void (BridgedDevice::*trouble)(), const std::string& who) {
  Pressed pressed{row};
  (row.*trouble)();
  const std::string said = what_is_said(pressed.hand);
  CHECK(pressed.hand.emergency_stop() == StopOutcome::unconfirmed);
  if (who.empty()) {
    wait_until([&] { return row.exerted_n() == 0.0; });
  }
  row.largest_n();
  for (int i = 0; i < 20; ++i) {
    static_cast<void>(press(pressed.hand, pressed_n));
  }
  CHECK(row.largest_n() == 0.0);  // not for a moment
  return fmt::format("'{}', {}, stop unconfirmed", said, who.empty() ? "force off" : who);
}
std::string device_hung(BridgedDevice& row) {
  return found(row, &BridgedDevice::hang, row.when_hung());
}
std::string device_unplugged(BridgedDevice& row) {
  return found(row, &BridgedDevice::unplug, {});
}

std::string device_lost(BridgedDevice& row) {
  Pressed pressed{row};
  row.lose_position();
  const std::string said = what_is_said(pressed.hand);
  wait_until([&] { return row.exerted_n() == 0.0; });
  return fmt::format("'{}', force off", said);
}

// It may go on, or let go where it waits for the other half in vain.
std::string every_other(BridgedDevice& row) {
  Pressed pressed{row};
  row.answer_every_other();
  row.largest_n();
  TickFault last = TickFault::none;
  for (int i = 0; i < 400; ++i) {
    last = press(pressed.hand, pressed_n);
    CHECK(last != TickFault::position_frozen);
    CHECK(last != TickFault::bad_reply);
    const double exerted_n = row.exerted_n();
    CHECK((exerted_n == pressed_n || exerted_n == 0.0));
  }
  CHECK(row.largest_n() <= pressed_n);
  return "force as asked, or off";
}

std::string numbers_jump(BridgedDevice& row) {
  if (row.numbering() == nullptr) {
    return "does not apply: the bridge numbers the samples";
  }
  Pressed pressed{row};
  row.numbering()->jump_in_numbers();
  while (press(pressed.hand, pressed_n) != TickFault::bad_reply) {
  }
  while (pressed.hand.zero_force() != StopOutcome::confirmed) {
  }
  CHECK(row.exerted_n() == 0.0);
  return "the reply was broken; force off";
}

// Where this program was kept waiting for 20 ms, the bridge let go, or the device's last sample is
// too old, and the bridge says so, truthfully: then the trial begins anew.
bool was_kept_waiting(TickFault found) {
  return found == TickFault::force_released || found == TickFault::amplifier_off;
}

// Periods of a loop at 1 kHz.
template <int Hundredths>
std::string reply_after(BridgedDevice& row) {
  constexpr double workspace_radius_m = 0.1;
  constexpr int enough_ticks = 300;
  const Bench bench{row};
  auto owned = std::make_unique<testing::PacedPipe>(bench.port);
  testing::PacedPipe& pipe = *owned;
  device::RemoteHand hand{
      bench.port, {std::chrono::milliseconds{3}, max_sample_age_s}, std::move(owned)};
  testing::PacedClock clock{pipe};
  pipe.reply_delay = 10'000 * Hundredths;
  TickFault found = TickFault::force_released;
  std::int64_t ticks = 0;
  while (was_kept_waiting(found)) {
    testing::StagedLoop stage{hand, clock, workspace_radius_m};
    stage.tick(enough_ticks);
    found = stage.loop->report().stopped_by;
    ticks = stage.loop->report().ticks;
  }
  CHECK(found == (Hundredths > 100 ? TickFault::periods_missed : TickFault::none));
  while (hand.zero_force() != StopOutcome::confirmed) {
  }
  return fmt::format("{} ticks, {}", ticks,
                     found == TickFault::none ? "no fault" : core::to_text(found));
}

constexpr const char* tells_no_force = "does not apply: the device measures no force";

// Taps of 60 ms in 200 ms. A tick of 1 ms ends when the device exerts its force and its reply has
// been heard, however long that takes.
template <int LateMs>
std::string force_told_late(BridgedDevice& row) {
  if (row.numbering() == nullptr) {
    return tells_no_force;
  }
  testing::MockBoard& board = *row.numbering();
  constexpr bool is_too_late = LateMs > 20;
  Pressed pressed{row};
  const auto pass_ms = [&](double force_n) {
    TickFault found = press(pressed.hand, force_n, 1e-3);
    while (found == TickFault::none &&
           (std::abs(row.exerted_n() - force_n) > 1e-6 ||
            std::abs(pressed.hand.detail().achieved_n.y() -
                     static_cast<double>(board.told_force_n())) > 1e-6)) {
      found = press(pressed.hand, force_n, 1e-9);
    }
    if (found == TickFault::none) {
      board.pass_ms();
    }
    return found;
  };
  const auto rest = [&] {
    for (int ms = 0; ms < 100;) {
      ms += pass_ms(0.0) == TickFault::none ? 1 : 0;
    }
    static_cast<void>(pressed.hand.begin());
  };
  rest();
  board.tell_force_late(LateMs);
  TickFault found = TickFault::none;
  for (int ms = 0; found == TickFault::none && (is_too_late || ms < 600);) {
    const int in_tap = ms % 200;
    found = pass_ms(in_tap < 60 ? 2.5 * std::sin(std::numbers::pi * in_tap / 60.0) : 0.0);
    ms += found == TickFault::none ? 1 : 0;
    if (was_kept_waiting(found)) {
      rest();
      found = TickFault::none;
    }
  }
  CHECK(found == (is_too_late ? TickFault::force_not_followed : TickFault::none));
  return found == TickFault::none ? "believed" : core::to_text(found);
}

std::string never_lets_go(BridgedDevice& row) {
  if (row.numbering() == nullptr) {
    return tells_no_force;
  }
  Pressed pressed{row};
  row.numbering()->hold();
  CHECK(pressed.hand.zero_force() == StopOutcome::unconfirmed);
  CHECK(pressed.hand.emergency_stop() == StopOutcome::unconfirmed);
  CHECK(row.exerted_n() == pressed_n);
  return "stop unconfirmed: force may be on";
}

// A hand that moves is no frozen one; one that does not move though force changes by 1 N is.
std::string device_frozen(BridgedDevice& row) {
  Pressed pressed{row};
  for (int i = 0; i < 200; ++i) {
    CHECK(press(pressed.hand, i % 2 == 0 ? pressed_n : 0.0) != TickFault::position_frozen);
  }
  row.freeze();
  // Either force for longer than the limit, again and again: where the machine is busy, a device
  // that stands still by then may be heard of only after the force has changed, or, after a sample
  // that came too late, as if for the first time.
  constexpr int held_ticks = 60;
  TickFault fault = TickFault::none;
  for (int i = 0; fault != TickFault::position_frozen; ++i) {
    const bool is_more = (i / held_ticks) % 2 == 1;
    fault = press(pressed.hand, is_more ? pressed_n + 1.0 : pressed_n, 1e-3);
  }
  return core::to_text(TickFault::position_frozen);
}

std::string second_device(BridgedDevice& row) {
  Pressed pressed{row};
  if (!row.plug_in_second()) {
    return "does not apply: " + row.why_no_second();
  }
  core::HandState before;
  core::HandState state;
  static_cast<void>(pressed.hand.read(before, 1e-5));
  std::this_thread::sleep_for(std::chrono::milliseconds{50});  // samples from before are too old
  int fresh = 0;
  for (int i = 0; i < 200; ++i) {
    fresh += press(pressed.hand, 1.0 + pressed_n * (i % 2)) == TickFault::none ? 1 : 0;
    static_cast<void>(pressed.hand.read(state, 1e-5));
    CHECK((state.position_m - before.position_m).norm() < 1e-3);
  }
  CHECK(fresh > 0);
  CHECK_FALSE(row.has_forced_second());
  return "goes on with its own";
}

std::string second_sender(BridgedDevice& row) {
  Pressed pressed{row};
  testing::RogueSender rogue{pressed.port};
  row.largest_n();
  for (int i = 0; i < 50; ++i) {
    rogue.send({0.0, row.max_force_n(), 0.0});
    rogue.send({0.0, -1.0, 0.0});
    static_cast<void>(press(pressed.hand, pressed_n));
    const double exerted_n = row.exerted_n();
    CHECK((exerted_n == pressed_n || exerted_n == 0.0));  // let go, where the machine is busy
  }
  CHECK(row.largest_n() <= pressed_n);
  return "not heard";
}

struct BridgeRow {
  const char* name;
  std::function<std::unique_ptr<BridgedDevice>()> make;
};
struct BridgeCell {
  const char* name;
  std::string (*show)(BridgedDevice& row);
};
}  // namespace

TEST_CASE(
    "each example bridge, in each trouble: force is as asked or off, a dead device is found, no "
    "stop is called confirmed that is not, and who must let go without the bridge is said",
    "[device][safety][remote][conformance][waits]") {
  const std::vector<BridgeRow> rows{
      {"serial_board", [] { return std::make_unique<SerialBoardRow>(); }},
      {"dhd", [] { return std::make_unique<DhdRow>(); }},
      {"openhaptics", [] { return std::make_unique<OpenHapticsRow>(); }},
      {"inverse3", [] { return std::make_unique<Inverse3Row>(); }}};
  const std::vector<BridgeCell> cells{{"force", force},
                                      {"killed", tapstudy_killed},
                                      {"stopped, continued, stopped", tapstudy_stopped},
                                      {"bridge killed", bridge_killed},
                                      {"bridge stopped and continued", bridge_stopped},
                                      {"hung", device_hung},
                                      {"unplugged", device_unplugged},
                                      {"frozen position", device_frozen},
                                      {"NaN", device_lost},
                                      {"every second sample", every_other},
                                      {"sample number jumps", numbers_jump},
                                      {"reply after 0.9 periods", reply_after<90>},
                                      {"reply after 1 period", reply_after<100>},
                                      {"reply after 1.05 periods", reply_after<105>},
                                      {"reply after 1.1 periods", reply_after<110>},
                                      {"reply after 1.5 periods", reply_after<150>},
                                      {"force told 0 ms late", force_told_late<0>},
                                      {"force told 5 ms late", force_told_late<5>},
                                      {"force told 15 ms late", force_told_late<15>},
                                      {"force told 50 ms late", force_told_late<50>},
                                      {"never lets go", never_lets_go},
                                      {"second device", second_device},
                                      {"second sender", second_sender}};
  for (const BridgeCell& cell : cells) {
    fmt::print("  {}\n", cell.name);
    for (const BridgeRow& row : rows) {
      CAPTURE(cell.name, row.name);
      const std::unique_ptr<BridgedDevice> device = row.make();
      fmt::print("    {:<16}{}\n", row.name, cell.show(*device));
    }
  }
}
