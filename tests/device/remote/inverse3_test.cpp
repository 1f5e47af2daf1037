#include <optional>

#include "device/remote/remote_hand.hpp"
#include "support/bridges/rogue_sender.hpp"
#include "support/bridges/service_stand_in.hpp"
#include "support/catch.hpp"
#include "support/example_bridge.hpp"
using namespace tapstudy;
using core::TickFault;
using core::Vec3;
using testing::ServiceStandIn;
using testing::unhurried;

namespace {
// Until the reply is of a sample that is not too old: this test may have been kept waiting.
TickFault read_fresh(device::RemoteHand& hand, core::HandState& state, const Vec3& force_n) {
  TickFault fault = TickFault::force_released;
  while (fault == TickFault::force_released || fault == TickFault::amplifier_off) {
    static_cast<void>(hand.begin());
    static_cast<void>(hand.write(force_n));
    fault = hand.read(state, 1e-3);
  }
  return fault;
}
}  // namespace

TEST_CASE("the bridge of the Inverse3 turns the service's frame into the device frame and back",
          "[device][remote]") {
  const ServiceStandIn service;
  const std::uint16_t port = testing::free_port();
  const testing::ExampleBridge bridge{port, service.command()};
  device::RemoteHand hand{port, {unhurried, 1.0}};
  REQUIRE(hand.introduction());
  CHECK(hand.introduction()->name == "Inverse3");
  CHECK(hand.introduction()->serial_number == "4711");
  core::HandState state;
  CHECK(read_fresh(hand, state, Vec3::Zero()) == TickFault::none);
  // 1 cm to the right of the centre, 3 cm towards the operator, 2 cm above
  CHECK((state.position_m - Vec3{0.01, 0.02, 0.03}).norm() == Approx(0.0).margin(1e-12));
  CHECK((state.velocity_m_s - Vec3{0.1, 0.3, -0.2}).norm() == Approx(0.0).margin(1e-12));
  while (service.force_n() != Vec3{1.0, -3.0, 2.0}) {
    static_cast<void>(hand.write({1.0, 2.0, 3.0}));
    static_cast<void>(hand.read(state, 1e-3));
  }
  while ((service.force_n() - Vec3{0.0, 0.0, 8.0}).norm() > 1e-9) {  // of 30 N, the limit
    static_cast<void>(hand.write({0.0, 30.0, 0.0}));
    static_cast<void>(hand.read(state, 1e-3));
  }
}

TEST_CASE("the Inverse3 has no force when tapstudy falls silent or its bridge ends",
          "[device][remote][safety]") {
  const ServiceStandIn service;
  const std::uint16_t port = testing::free_port();
  testing::ExampleBridge bridge{port, service.command()};
  device::RemoteHand hand{port, {unhurried, 1.0}};
  core::HandState state;
  while (service.force_n().z() != 2.0) {
    static_cast<void>(hand.write({0.0, 2.0, 0.0}));
    static_cast<void>(hand.read(state, 1e-3));
  }
  if (GENERATE(false, true)) {
    bridge.end(SIGTERM);
  }
  while (service.force_n() != Vec3::Zero()) {
  }
  SUCCEED("force is off, however long it took");
}

TEST_CASE("a service of the Inverse3 that hangs or ends is told, and gets a zero force",
          "[device][remote][safety]") {
  ServiceStandIn service;
  const std::uint16_t port = testing::free_port();
  const testing::ExampleBridge bridge{port, service.command()};
  device::RemoteHand hand{port, {unhurried, 1.0}};
  core::HandState state;
  while (service.force_n().z() != 2.0) {
    static_cast<void>(hand.write({0.0, 2.0, 0.0}));
    static_cast<void>(hand.read(state, 1e-3));
  }
  const bool is_hung = GENERATE(true, false);
  if (is_hung) {
    service.is_silent = true;
  } else {
    service.end();
  }
  TickFault fault = TickFault::none;
  while (fault != TickFault::amplifier_off) {
    static_cast<void>(hand.begin());
    static_cast<void>(hand.write({0.0, 2.0, 0.0}));
    fault = hand.read(state, 1e-3);
  }
  if (!is_hung) {
    CHECK(hand.text().starts_with("the service: "));
    return;
  }
  CHECK(hand.text() == "no samples from the device");
  while (service.force_n() != Vec3::Zero()) {  // it hears, and answers nothing
  }
}

// The peer's kernel tells: its queue holds what is not acknowledged. A state that a force answers
// is acknowledged by that force, so that two forces are under way here, of which the second is
// zero.
TEST_CASE(
    "a state that the Inverse3's bridge answers with no force is acknowledged once it is read",
    "[device][remote]") {
  ServiceStandIn service;
  const std::uint16_t port = testing::free_port();
  const testing::ExampleBridge bridge{port, service.command()};
  testing::RogueSender tapstudy{port};
  std::uint32_t number = 0;
  const auto sample_after = [&](const Vec3& force_n) {
    std::optional<device::RemoteReply> reply;
    while (!reply) {  // the bridge may not be there yet
      tapstudy.ask(++number, force_n);
      reply = tapstudy.next_reply();
    }
    return reply->sample->number;
  };
  sample_after(Vec3::Zero());  // it is connected
  for (int round = 0; round < 5; ++round) {
    service.is_silent = false;
    service.tell_state_unasked();
    while (service.force_n().z() != 2.0) {
      sample_after({0.0, 2.0, 0.0});
    }
    for (int i = 0; i < 100; ++i) {  // as the kernel sees it, a dialogue
      sample_after({0.0, 2.0, 0.0});
    }
    service.is_silent = true;
    for (int i = 0; i < 100; ++i) {
      sample_after({0.0, 2.0, 0.0});
    }
    std::uint64_t before = sample_after(Vec3::Zero());
    while (service.force_n() != Vec3::Zero()) {
      before = sample_after(Vec3::Zero());
    }
    service.tell_state_unasked();
    while (sample_after(Vec3::Zero()) == before) {
    }
    CHECK(service.unacknowledged_bytes() == 0);
  }
}

TEST_CASE("the bridge of the Inverse3 ends where the service knows none", "[device][remote]") {
  const ServiceStandIn service{false};
  testing::ExampleBridge bridge{testing::free_port(), service.command()};
  CHECK(bridge.exit_code() == 1);
}
