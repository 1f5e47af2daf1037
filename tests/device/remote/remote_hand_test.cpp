#include "device/remote/remote_hand.hpp"

#include <arpa/inet.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstring>
#include <thread>

#include "device/hand/replay_hand.hpp"
#include "device/remote/packets.hpp"
#include "support/example_bridge.hpp"
using namespace tapstudy;
using core::TickFault;
using core::Vec3;

using testing::ExampleBridge;
using testing::free_port;

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

TEST_CASE("the bridge's finger moves under the force it is sent", "[device][remote]") {
  const std::uint16_t port = free_port();
  ExampleBridge bridge{port};
  device::RemoteHand hand{port, std::chrono::milliseconds{100}};
  core::HandState state;
  double sideways_m = 0.0;
  for (int i = 0; i < 2000; ++i) {
    REQUIRE(hand.read(state) == TickFault::none);
    REQUIRE(hand.write({1.0, 0.0, 0.0}) == TickFault::none);
    sideways_m = state.position_m.x();
  }
  CHECK(sideways_m == Approx(1.0 / 400.0).epsilon(0.01));  // the example's muscle
  bridge.end();
  TickFault fault = TickFault::none;
  for (int i = 0; i < 3 && fault == TickFault::none; ++i) {
    fault = hand.read(state);
  }
  CHECK((fault == TickFault::device_gone || fault == TickFault::no_reply));
}

TEST_CASE("a remote device that is not there is said, not waited for", "[device][remote]") {
  CHECK_THROWS_WITH((device::RemoteHand{free_port(), std::chrono::milliseconds{3}}),
                    Catch::Matchers::Contains("nobody answers"));
}

TEST_CASE("a replayed hand goes where the recorded one went, and stays there", "[device][replay]") {
  device::ReplayHand hand{{{Vec3{1, 0, 0}, Vec3{0, 1, 0}}, {Vec3{2, 0, 0}, Vec3{0, 2, 0}}},
                          "a test"};
  core::HandState state;
  for (int turn = 0; turn < 2; ++turn) {
    CHECK(hand.read(state) == TickFault::none);
    CHECK(state.position_m == Vec3{1, 0, 0});
    CHECK(hand.read(state) == TickFault::none);
    CHECK(state.velocity_m_s == Vec3{0, 2, 0});
    CHECK(hand.read(state) == TickFault::none);
    CHECK(state.position_m == Vec3{2, 0, 0});
    CHECK(state.velocity_m_s == Vec3::Zero());
    hand.rewind();
  }
}
