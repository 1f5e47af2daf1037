#include "device/remote/remote_hand.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <chrono>
#include <cstring>
#include <limits>

#include "device/hand/replay_hand.hpp"
#include "device/remote/packets.hpp"
#include "support/catch.hpp"
#include "support/example_bridge.hpp"
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
