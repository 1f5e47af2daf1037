#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "device/remote/remote_hand.hpp"
#include "support/catch.hpp"
#include "support/example_bridge.hpp"
using namespace tapstudy;
using core::TickFault;
using core::Vec3;
using testing::unhurried;
using Json = nlohmann::json;
using Tcp = boost::asio::ip::tcp;
namespace beast = boost::beast;

namespace {
// Stands in for the vendor's service: one device, whose state answers each force.
class ServiceStandIn {
 public:
  explicit ServiceStandIn(bool has_device = true) : has_device_{has_device} {
    acceptor_.async_accept([this](const boost::system::error_code& error, Tcp::socket socket) {
      if (!error) {
        begin(std::move(socket));
      }
    });
    thread_ = std::thread{[this] { context_.run(); }};
  }
  ~ServiceStandIn() { end(); }
  ServiceStandIn(const ServiceStandIn&) = delete;
  ServiceStandIn& operator=(const ServiceStandIn&) = delete;
  ServiceStandIn(ServiceStandIn&&) = delete;
  ServiceStandIn& operator=(ServiceStandIn&&) = delete;
  // The connection is closed, as where the service is killed.
  void end() {
    context_.stop();
    if (thread_.joinable()) {
      thread_.join();
      session_.reset();
    }
  }
  std::string port() const { return std::to_string(acceptor_.local_endpoint().port()); }
  Vec3 force_n() const { return {force_n_[0], force_n_[1], force_n_[2]}; }  // in its frame
  std::atomic<bool> is_silent{false};

 private:
  void begin(Tcp::socket socket) {
    session_ = std::make_unique<beast::websocket::stream<Tcp::socket>>(std::move(socket));
    session_->accept();
    tell_state();
    hear_next();
  }
  void hear_next() {
    session_->async_read(heard_, [this](const boost::system::error_code& error, std::size_t) {
      if (error) {
        return;
      }
      const Json force = Json::parse(beast::buffers_to_string(heard_.data()))
                             .at("inverse3")[0]
                             .at("commands")
                             .at("set_cursor_force")
                             .at("values");
      heard_.consume(heard_.size());
      force_n_[0] = force.at("x").get<double>();
      force_n_[1] = force.at("y").get<double>();
      force_n_[2] = force.at("z").get<double>();
      if (!is_silent) {
        tell_state();
      }
      hear_next();
    });
  }
  void tell_state() {
    Json devices = Json::array();
    if (has_device_) {
      devices.push_back({{"device_id", "4711"},
                         {"state",
                          {{"cursor_position", {{"x", 0.05}, {"y", -0.20}, {"z", 0.18}}},
                           {"cursor_velocity", {{"x", 0.1}, {"y", 0.2}, {"z", 0.3}}}}}});
    }
    boost::system::error_code gone;
    session_->write(boost::asio::buffer(Json{{"inverse3", devices}}.dump()), gone);
  }

  bool has_device_;
  boost::asio::io_context context_{1};
  Tcp::acceptor acceptor_{context_, {boost::asio::ip::address_v4::loopback(), 0}};
  std::unique_ptr<beast::websocket::stream<Tcp::socket>> session_;
  beast::flat_buffer heard_;
  std::array<std::atomic<double>, 3> force_n_{};
  std::thread thread_;
};

// The bridge with the stand-in's limits: 8 N, its centre at 0.04, -0.17, 0.16 m.
std::vector<std::string> command(const ServiceStandIn& service) {
  return {
      testing::inverse3_program(), "8.0", "2000", "0.1", "0.04", "-0.17", "0.16", service.port()};
}

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
  const testing::ExampleBridge bridge{port, command(service)};
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
  testing::ExampleBridge bridge{port, command(service)};
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
  const testing::ExampleBridge bridge{port, command(service)};
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

TEST_CASE("the bridge of the Inverse3 ends where the service knows none", "[device][remote]") {
  const ServiceStandIn service{false};
  testing::ExampleBridge bridge{testing::free_port(), command(service)};
  CHECK(bridge.exit_code() == 1);
}
