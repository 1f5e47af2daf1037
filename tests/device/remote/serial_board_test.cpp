#include "device/remote/remote_hand.hpp"
#include "support/bridges/mock_board.hpp"
#include "support/catch.hpp"
#include "support/example_bridge.hpp"
using namespace tapstudy;
using core::TickFault;
using testing::ExampleBridge;
using testing::free_port;
using testing::MockBoard;
using testing::unhurried;

namespace {
// A sample of the board comes a moment after the first request that asks for it.
TickFault first_reading(device::RemoteHand& hand, core::HandState& state) {
  TickFault fault = TickFault::amplifier_off;
  for (int i = 0; i < 100'000 && fault == TickFault::amplifier_off; ++i) {
    static_cast<void>(hand.begin());
    fault = hand.read(state, 1e-3);
  }
  return fault;
}
}  // namespace

TEST_CASE("a microcontroller at a serial port is a device, and noise on its line is not a sample",
          "[device][remote]") {
  MockBoard board;
  const bool is_noisy = GENERATE(false, true);
  if (is_noisy) {
    board.be_noisy();
  }
  const std::uint16_t port = free_port();
  const ExampleBridge bridge{port, {testing::serial_board_program(), board.path()}};
  device::RemoteHand hand{port, {unhurried}};
  REQUIRE(hand.introduction());
  CHECK(hand.introduction()->name == "desk arm");
  CHECK(hand.introduction()->serial_number == "A7");
  CHECK(hand.introduction()->max_force_n == 3.0);
  CHECK(hand.introduction()->rate_hz == 1000.0);
  core::HandState state;
  for (const double force_n : {0.0, 2.0, 300.0}) {
    for (double told_n = -1.0; told_n != std::min(force_n, 3.0);) {
      REQUIRE(hand.write({0.0, force_n, 0.0}) == TickFault::none);
      static_cast<void>(first_reading(hand, state));
      told_n = hand.detail().achieved_n.y();
      REQUIRE((std::isnan(told_n) || told_n == 0.0 || told_n == 2.0 || told_n == 3.0));
    }
    CHECK(state.position_m == Eigen::Vector3f{0.01F, 0.02F, 0.03F}.cast<double>());
  }
}

TEST_CASE("a board has no force when tapstudy falls silent, or its bridge ends",
          "[device][remote][safety]") {
  MockBoard board;
  const std::uint16_t port = free_port();
  ExampleBridge bridge{port, {testing::serial_board_program(), board.path()}};
  {
    device::RemoteHand hand{port, {unhurried}};
    core::HandState state;
    while (board.force_n() != 2.0F) {
      REQUIRE(hand.write({0.0, 2.0, 0.0}) == TickFault::none);
      static_cast<void>(hand.read(state, 1e-3));
    }
    if (GENERATE(false, true)) {
      bridge.end(SIGTERM);
    }
    while (board.force_n() != 0.0F) {
    }
  }
  SUCCEED("force is off, however long it took");
}

TEST_CASE("a board that gives no samples, or is unplugged, ends the trial, and the bridge says why",
          "[device][remote][safety]") {
  MockBoard board;
  const std::uint16_t port = free_port();
  const ExampleBridge bridge{port, {testing::serial_board_program(), board.path()}};
  device::RemoteHand hand{port, {unhurried, 10.0}};
  core::HandState state;
  static_cast<void>(first_reading(hand, state));
  const char* said = "no samples from the device";
  if (GENERATE(false, true)) {
    board.unplug();
    said = "the serial port of the board is gone";
  } else {
    board.fall_silent();
  }
  // Where this program is kept waiting, a board that is about to be unplugged has no new samples.
  constexpr int enough = 10'000;
  TickFault fault = TickFault::none;
  for (int i = 0; i < enough && (fault != TickFault::amplifier_off || hand.text() != said); ++i) {
    static_cast<void>(hand.begin());
    fault = hand.read(state, 1e-3);
  }
  CHECK(fault == TickFault::amplifier_off);
  CHECK(hand.text() == said);
}

TEST_CASE("a second program that would drive a board is refused, and the first goes on",
          "[device][remote][safety]") {
  MockBoard board;
  const std::uint16_t port = free_port();
  const ExampleBridge bridge{port, {testing::serial_board_program(), board.path()}};
  device::RemoteHand hand{port, {unhurried, 10.0}};
  core::HandState state;
  while (first_reading(hand, state) != TickFault::none) {  // it was silent for too long
  }
  ExampleBridge second{static_cast<std::uint16_t>(port + 1),
                       {testing::serial_board_program(), board.path()}};
  CHECK(second.exit_code() == 1);
  while (first_reading(hand, state) != TickFault::none) {  // it was silent for too long
  }
}
