#include "device/remote/remote_hand.hpp"
#include "support/bridges/rogue_sender.hpp"
#include "support/catch.hpp"
#include "support/dhd/stand_in.hpp"
#include "support/example_bridge.hpp"
#include "support/mapped_stand_in.hpp"
using namespace tapstudy;
using core::TickFault;
using core::Vec3;
using testing::DhdStandIn;
using testing::unhurried;

namespace {
// The bridge, built with a stand-in for the vendor's library, and the device that it sees.
class DhdBench {
 public:
  explicit DhdBench(bool has_watchdog = true) { device().has_watchdog = has_watchdog; }
  DhdStandIn& device() { return shared_.device(); }
  Vec3 force_n() { return {device().force_n[0], device().force_n[1], device().force_n[2]}; }

 private:
  testing::MappedStandIn<DhdStandIn> shared_;
};
}  // namespace

TEST_CASE("the bridge of the DHD interface turns its frame into the device frame and back",
          "[device][remote]") {
  DhdBench bench;
  const std::uint16_t port = testing::free_port();
  const testing::ExampleBridge bridge{port, {testing::dhd_program(), "4.0", "3000", "0.05"}};
  device::RemoteHand hand{port, {unhurried, 1.0}};
  REQUIRE(hand.introduction());
  CHECK(hand.introduction()->name == "stand-in");
  CHECK(hand.introduction()->serial_number == "4711");
  CHECK(bench.device().watchdog * 125e-6 == Approx(0.02));
  core::HandState state;
  REQUIRE(hand.write({1.0, 2.0, 3.0}) == TickFault::none);
  TickFault fault = TickFault::force_released;
  while (fault == TickFault::force_released) {  // this test may have been kept waiting
    static_cast<void>(hand.begin());
    fault = hand.read(state, 1e-3);
  }
  CHECK(fault == TickFault::none);
  CHECK(state.position_m == Vec3{0.02, 0.03, 0.01});  // right, up, towards the participant
  REQUIRE(hand.write({0.0, 30.0, 0.0}) == TickFault::none);
  while (bench.force_n() != Vec3{0.0, 0.0, 4.0}) {
    static_cast<void>(hand.read(state, 1e-3));
  }
}

TEST_CASE("the DHD's device has no force when tapstudy falls silent, its bridge ends or it is gone",
          "[device][remote][safety]") {
  DhdBench bench;
  const std::uint16_t port = testing::free_port();
  testing::ExampleBridge bridge{port, {testing::dhd_program(), "4.0", "3000", "0.05"}};
  device::RemoteHand hand{port, {unhurried, 1.0}};
  core::HandState state;
  while (bench.force_n().z() != 2.0) {
    REQUIRE(hand.write({0.0, 2.0, 0.0}) == TickFault::none);
    static_cast<void>(hand.read(state, 1e-3));
  }
  const int what = GENERATE(0, 1, 2);
  if (what == 1) {
    bridge.end(SIGTERM);
    CHECK_FALSE(bench.device().is_force_enabled);
  } else if (what == 2) {
    bench.device().is_gone = true;
    static_cast<void>(hand.begin());
    CHECK(hand.read(state, 1e-3) == TickFault::amplifier_off);
    CHECK(hand.text() == "device not ready");
  }
  while (bench.force_n() != Vec3::Zero()) {
  }
  SUCCEED("force is off, however long it took");
}

TEST_CASE("a device of the DHD interface without a watchdog gets no force",
          "[device][remote][safety]") {
  DhdBench bench{false};
  const std::uint16_t port = testing::free_port();
  testing::ExampleBridge bridge{port, {testing::dhd_program(), "4.0", "3000", "0.05"}};
  CHECK(bridge.exit_code() == 1);
  CHECK_FALSE(bench.device().is_force_enabled);
}

TEST_CASE("an introduction or an unknown request in mid-session leaves the device without force",
          "[device][remote][safety]") {
  DhdBench bench;
  const std::uint16_t port = testing::free_port();
  const testing::ExampleBridge bridge{port, {testing::dhd_program(), "4.0", "3000", "0.05"}};
  testing::RogueSender sender{port};
  std::uint32_t number = 0;
  while (bench.force_n().z() != 2.0) {
    sender.ask(++number, {0.0, 2.0, 0.0});
    static_cast<void>(sender.next_reply(std::chrono::milliseconds{5}));
  }
  // each says as an exchange would that the sender is alive, so that no silence ends the force
  const auto asked = GENERATE(device::wire::Asked::introduction, device::wire::Asked{7});
  for (int i = 0; i < 100 && bench.force_n() != Vec3::Zero(); ++i) {
    sender.ask(++number, {0.0, 2.0, 0.0}, asked);
    static_cast<void>(sender.next_reply(std::chrono::milliseconds{1}));
  }
  CHECK(bench.force_n() == Vec3::Zero());
  while (bench.force_n().z() != 2.0) {  // until the next exchange
    sender.ask(++number, {0.0, 2.0, 0.0});
    static_cast<void>(sender.next_reply(std::chrono::milliseconds{5}));
  }
}

TEST_CASE("a bridge whose limit of force, of stiffness or of space is absurd does not begin",
          "[device][remote][safety]") {
  DhdBench bench;
  const auto [force, stiffness, radius] =
      GENERATE(table<const char*, const char*, const char*>({{"inf", "3000", "0.05"},
                                                             {"1e9", "3000", "0.05"},
                                                             {"4.0", "inf", "0.05"},
                                                             {"4.0", "3000", "1e-9"}}));
  testing::ExampleBridge bridge{testing::free_port(),
                                {testing::dhd_program(), force, stiffness, radius}};
  CHECK(bridge.exit_code() == 1);
  CHECK(bench.force_n() == Vec3::Zero());
}
