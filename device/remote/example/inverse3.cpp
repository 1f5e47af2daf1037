// The Inverse3 of Haply, through the local service that its vendor ships (JSON over a WebSocket,
// version 3.1 of its format), as a device of tapstudy:
//
//   c++ -std=c++20 -O2 -o inverse3 inverse3.cpp -lpthread    (Boost.Beast, nlohmann/json)
//   inverse3 PORT MAX_FORCE_N MAX_STIFFNESS_N_PER_M WORKSPACE_RADIUS_M
//            CENTRE_X_M CENTRE_Y_M CENTRE_Z_M [SERVICE_PORT]
//   and in the rig   device: remote   remote: {port: PORT}
//
// The limits are in the data sheet; the centre of the workspace is in the service's frame: x to the
// right, y away from the operator, z up. The service answers each force with a state, so that one
// force is always under way, the newest. Each state is acknowledged at once: a service may wait for
// that before it sends the next (Nagle's algorithm), and by itself the kernel takes 40 ms. When
// tapstudy falls silent the force is zero after 20 ms, when the service does, the bridge says so.
// What the service does with the last force when this program is killed is up to it: kill it once
// (kill -9) with nobody at the device before a rig relies on it.
#include <netinet/tcp.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "server.hpp"
namespace {
namespace beast = boost::beast;
using Json = nlohmann::json;
using Tcp = boost::asio::ip::tcp;
using Error = boost::system::error_code;

struct Limits {
  double max_force_n{};
  double max_stiffness_n_per_m{};
  double workspace_radius_m{};
  bridge::wire::Vector centre_m{};  // in the service's frame
};

// x, y, z of the service to right, up, towards the operator.
bridge::wire::Vector from_service(const Json& values) {
  return {values.at("x").get<double>(), values.at("z").get<double>(),
          -values.at("y").get<double>()};
}
Json to_service(const bridge::wire::Vector& ours) {
  return {{"x", ours[0]}, {"y", -ours[2]}, {"z", ours[1]}};
}

class Inverse3 final : public bridge::Device {
 public:
  // Ends the program if there is no service, or no device at it.
  Inverse3(const Limits& limits, const std::string& service_port) : limits_{limits} {
    try {
      Tcp::resolver resolver{context_};
      boost::asio::connect(beast::get_lowest_layer(service_),
                           resolver.resolve("127.0.0.1", service_port));
      beast::get_lowest_layer(service_).set_option(Tcp::no_delay{true});
      service_.handshake("localhost:" + service_port, "/");
      service_.read(received_);
      descriptor_ = beast::get_lowest_layer(service_).native_handle();
      acknowledge_at_once();
    } catch (const boost::system::system_error& error) {
      give_up(error.what());
    }
    take_message();
    if (id_.empty()) {
      give_up("the service tells of no Inverse3");
    }
    read_next();
    send_force();
  }

  bridge::wire::Introduction introduction() override {
    bridge::wire::Introduction told;
    told.workspace_radius_m = limits_.workspace_radius_m;
    told.max_force_n = limits_.max_force_n;
    told.max_stiffness_n_per_m = limits_.max_stiffness_n_per_m;
    told.rate_hz = 4000.0;
    bridge::put_text(told.name, "Inverse3");
    bridge::put_text(told.serial_number, id_);
    return told;
  }
  void exert(const bridge::wire::Vector& force_n) override {
    force_n_ = force_n;
    asked_at_ = bridge::Clock::now();
    // Letting go does not wait for the service's next state. It is sent once: if each zero force
    // were, states would queue at a service that sends the next one when the last is acknowledged,
    // and all further ones would arrive late.
    const bridge::wire::Vector zero{};
    if (states_awaited_ == 0 || (force_n == zero && force_sent_n_ != zero)) {
      send_force();
    }
    run();
  }
  void sample(bridge::wire::Reply& reply) override {
    run();
    reply = newest_;
    reply.age_s = bridge::seconds_since(taken_at_);
    if (!trouble_.empty()) {
      reply.status &= ~bridge::wire::motors_on;
      bridge::put_text(reply.text, trouble_);
    }
  }
  int descriptor() const override { return trouble_.empty() ? descriptor_ : -1; }
  void take_input() override { run(); }

 private:
  [[noreturn]] static void give_up(const char* what) {
    std::fprintf(stderr, "inverse3: %s\n", what);
    std::exit(1);
  }
  void run() {
    context_.restart();
    context_.poll();
  }
  // The kernel forgets it, so that it is said again with each state.
  void acknowledge_at_once() const {
    const int yes = 1;
    setsockopt(descriptor_, IPPROTO_TCP, TCP_QUICKACK, &yes, sizeof yes);
  }
  void read_next() {
    service_.async_read(received_, [this](const Error& error, std::size_t) {
      if (error) {
        return note(error);
      }
      acknowledge_at_once();
      states_awaited_ -= states_awaited_ > 0 ? 1 : 0;
      take_message();
      if (states_awaited_ == 0) {
        send_force();
      }
      read_next();
    });
  }
  // One at a time; what changed meanwhile goes with the next one.
  void send_force() {
    if (is_sending_ || !trouble_.empty()) {
      is_changed_ = true;
      return;
    }
    if (bridge::Clock::now() - asked_at_ > bridge::max_silence) {
      force_n_ = {};  // this program was stopped in between
    }
    is_sending_ = true;
    is_changed_ = false;
    ++states_awaited_;
    force_sent_n_ = force_n_;
    const Json force{{"set_cursor_force", {{"values", to_service(force_n_)}}}};
    sent_ = Json{{"inverse3", Json::array({{{"device_id", id_}, {"commands", force}}})}}.dump();
    service_.async_write(boost::asio::buffer(sent_), [this](const Error& error, std::size_t) {
      is_sending_ = false;
      if (error) {
        return note(error);
      }
      if (is_changed_) {
        send_force();
      }
    });
  }
  void note(const Error& error) { trouble_ = "the service: " + error.message(); }

  void take_message() {
    const Json message = Json::parse(beast::buffers_to_string(received_.data()), nullptr, false);
    received_.consume(received_.size());
    try {
      for (const Json& device : message.at("inverse3")) {
        take_device(device);
      }
    } catch (const Json::exception&) {
      return;  // of another device, or of none: the sample before stays the newest
    }
  }
  void take_device(const Json& device) {
    if (id_.empty()) {
      id_ = device.at("device_id").get<std::string>();
    }
    if (device.at("device_id") != id_) {
      return;
    }
    const Json& state = device.at("state");
    bridge::wire::Vector position_m = from_service(state.at("cursor_position"));
    const bridge::wire::Vector centre_m{limits_.centre_m[0], limits_.centre_m[2],
                                        -limits_.centre_m[1]};
    for (std::size_t axis = 0; axis < position_m.size(); ++axis) {
      position_m[axis] -= centre_m[axis];
    }
    newest_.velocity_m_s = from_service(state.at("cursor_velocity"));
    newest_.position_m = position_m;
    newest_.orientation.fill(std::nan(""));
    newest_.exerted_n.fill(std::nan(""));  // commanded, not measured
    newest_.exerted_n_m.fill(std::nan(""));
    ++newest_.sample;
    taken_at_ = bridge::Clock::now();
  }

  Limits limits_;
  boost::asio::io_context context_{1};
  beast::websocket::stream<Tcp::socket> service_{context_};
  int descriptor_ = -1;
  beast::flat_buffer received_;
  std::string sent_;
  std::string id_;
  std::string trouble_;
  bool is_sending_ = false;
  bool is_changed_ = false;
  int states_awaited_ = 0;
  bridge::wire::Vector force_n_{};
  bridge::Clock::time_point asked_at_{};
  bridge::wire::Vector force_sent_n_{};
  bridge::wire::Reply newest_;
  bridge::Clock::time_point taken_at_{};
};

bool are_above_0(const Limits& limits) {
  return limits.max_force_n > 0.0 && limits.max_stiffness_n_per_m > 0.0 &&
         limits.workspace_radius_m > 0.0;
}
}  // namespace

int main(int argc, char** argv) {
  const bool is_complete = argc == 8 || argc == 9;
  const auto number = [&](int place) { return is_complete ? std::atof(argv[place]) : 0.0; };
  const Limits limits{number(2), number(3), number(4), {number(5), number(6), number(7)}};
  if (!are_above_0(limits)) {
    std::fputs(
        "usage: inverse3 PORT MAX_FORCE_N MAX_STIFFNESS_N_PER_M WORKSPACE_RADIUS_M CENTRE_X_M "
        "CENTRE_Y_M CENTRE_Z_M [SERVICE_PORT]\n",
        stderr);
    return 2;
  }
  Inverse3 device{limits, argc == 9 ? argv[8] : "10001"};
  bridge::Server{std::atoi(argv[1]), device}.run();
}
