#include "device/remote/remote_hand.hpp"
#include "support/catch.hpp"
#include "support/example_bridge.hpp"
#include "support/mapped_stand_in.hpp"
#include "support/openhaptics/stand_in.hpp"
using namespace tapstudy;
using core::TickFault;
using core::Vec3;
using testing::OpenHapticsStandIn;
using testing::unhurried;

namespace {
// The bridge, built with a stand-in for the vendor's library, and the device that it sees.
class OpenHapticsBench {
 public:
  OpenHapticsStandIn& device() { return shared_.device(); }
  Vec3 force_n() { return {device().force_n[0], device().force_n[1], device().force_n[2]}; }

 private:
  testing::MappedStandIn<OpenHapticsStandIn> shared_;
};
}  // namespace

TEST_CASE("the bridge of OpenHaptics turns millimetres into metres and keeps the limit of force",
          "[device][remote]") {
  OpenHapticsBench bench;
  const std::uint16_t port = testing::free_port();
  const testing::ExampleBridge bridge{port, {testing::openhaptics_program()}};
  device::RemoteHand hand{port, {unhurried, 1.0}};
  REQUIRE(hand.introduction());
  CHECK(hand.introduction()->name == "stand-in");
  CHECK(hand.introduction()->workspace_radius_m == Approx(0.035));  // half of the shortest side
  CHECK(hand.introduction()->max_stiffness_n_per_m == Approx(2350.0));
  core::HandState state;
  TickFault fault = TickFault::force_released;
  while (fault == TickFault::force_released || fault == TickFault::amplifier_off) {
    static_cast<void>(hand.begin());  // this test may have been kept waiting
    static_cast<void>(hand.write({0.0, 1.0, 0.0}));
    fault = hand.read(state, 1e-3);
  }
  CHECK(fault == TickFault::none);
  CHECK((state.position_m - Vec3{0.01, 0.02, 0.03}).norm() == Approx(0.0).margin(1e-12));
  while ((bench.force_n() - Vec3{0.0, 3.3, 0.0}).norm() > 1e-9) {
    static_cast<void>(hand.write({0.0, 30.0, 0.0}));
    static_cast<void>(hand.read(state, 1e-3));
  }
}

TEST_CASE(
    "a device of OpenHaptics has no force when tapstudy falls silent, its bridge ends or it "
    "is gone",
    "[device][remote][safety]") {
  OpenHapticsBench bench;
  const std::uint16_t port = testing::free_port();
  testing::ExampleBridge bridge{port, {testing::openhaptics_program()}};
  device::RemoteHand hand{port, {unhurried, 1.0}};
  core::HandState state;
  while (bench.force_n().y() != 2.0) {
    static_cast<void>(hand.write({0.0, 2.0, 0.0}));
    static_cast<void>(hand.read(state, 1e-3));
  }
  const int what = GENERATE(0, 1, 2);
  if (what == 1) {
    bridge.end(SIGTERM);
    CHECK_FALSE(bench.device().is_running);
  } else if (what == 2) {
    bench.device().is_gone = true;
    TickFault fault = TickFault::none;
    while (fault != TickFault::amplifier_off) {
      static_cast<void>(hand.begin());
      static_cast<void>(hand.write({0.0, 2.0, 0.0}));
      fault = hand.read(state, 1e-3);
    }
    CHECK(hand.text() == "communication error");
  }
  while (bench.force_n() != Vec3::Zero()) {
  }
  SUCCEED("force is off, however long it took");
}

TEST_CASE("the bridge of OpenHaptics ends where no device can be opened", "[device][remote]") {
  OpenHapticsBench bench;
  bench.device().is_gone = true;
  testing::ExampleBridge bridge{testing::free_port(), {testing::openhaptics_program()}};
  CHECK(bridge.exit_code() == 1);
}
