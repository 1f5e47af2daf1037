#pragma once
#include <linux/sockios.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/haptics/haptic_state.hpp"
#include "support/built_paths.hpp"
namespace tapstudy::testing {
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
  // The bridge with the stand-in's limits: 8 N, its centre at 0.04, -0.17, 0.16 m.
  std::vector<std::string> command() const {
    return {inverse3_program(),
            "8.0",
            "2000",
            "0.1",
            "0.04",
            "-0.17",
            "0.16",
            std::to_string(acceptor_.local_endpoint().port())};
  }
  core::Vec3 force_n() const { return {force_n_[0], force_n_[1], force_n_[2]}; }  // in its frame
  // Up, of those sent since the last call.
  double largest_force_n() { return largest_n_.exchange(0.0); }
  void tremble() { tremor_m_ = 1e-4; }
  void stand_still() { tremor_m_ = 0.0; }
  void lose_position() { is_lost_ = true; }
  bool has_forced_another() const { return has_forced_another_; }
  void answer_every_other() { answers_every_other_ = true; }
  // Told before the first, elsewhere.
  void plug_in_second() { has_second_ = true; }
  // A state that answers no force.
  void tell_state_unasked() {
    boost::asio::post(context_, [this] { tell_state(); });
  }
  // What it has sent and the bridge's kernel has not acknowledged.
  int unacknowledged_bytes() const {
    int bytes = -1;
    ioctl(session_->next_layer().native_handle(), SIOCOUTQ, &bytes);
    return bytes;
  }
  std::atomic<bool> is_silent{false};

 private:
  using Json = nlohmann::json;
  using Tcp = boost::asio::ip::tcp;
  using Session = boost::beast::websocket::stream<Tcp::socket>;
  void begin(Tcp::socket socket) {
    session_ = std::make_unique<Session>(std::move(socket));
    session_->accept();
    tell_state();
    hear_next();
  }
  void hear_next() {
    session_->async_read(heard_, [this](const boost::system::error_code& error, std::size_t) {
      if (error) {
        return;
      }
      const Json told = Json::parse(boost::beast::buffers_to_string(heard_.data())).at("inverse3");
      heard_.consume(heard_.size());
      has_forced_another_ =
          has_forced_another_ || told.size() != 1 || told[0].at("device_id") != "4711";
      const Json& force = told[0].at("commands").at("set_cursor_force").at("values");
      force_n_[0] = force.at("x").get<double>();
      force_n_[1] = force.at("y").get<double>();
      force_n_[2] = force.at("z").get<double>();
      largest_n_ = std::max(largest_n_.load(), force_n_[2].load());
      if (!is_silent && (!answers_every_other_ || ++asked_ % 2 == 0)) {
        tell_state();
      }
      hear_next();
    });
  }
  void tell_state() {
    Json devices = Json::array();
    const double tremor_m = tremor_m_ * std::sin(0.06 * ++states_);
    if (has_second_) {
      devices.push_back({{"device_id", "4712"},
                         {"state",
                          {{"cursor_position", {{"x", 0.0}, {"y", 0.0}, {"z", 0.0}}},
                           {"cursor_velocity", {{"x", 0.0}, {"y", 0.0}, {"z", 0.0}}}}}});
    }
    if (has_device_) {
      devices.push_back(
          {{"device_id", "4711"},
           {"state",
            {{"cursor_position",
              {{"x", 0.05 + tremor_m}, {"y", is_lost_ ? std::nan("") : -0.20}, {"z", 0.18}}},
             {"cursor_velocity", {{"x", 0.1}, {"y", 0.2}, {"z", 0.3}}}}}});
    }
    boost::system::error_code gone;
    session_->write(boost::asio::buffer(Json{{"inverse3", devices}}.dump()), gone);
  }

  bool has_device_;
  boost::asio::io_context context_{1};
  Tcp::acceptor acceptor_{context_, {boost::asio::ip::address_v4::loopback(), 0}};
  std::unique_ptr<Session> session_;
  boost::beast::flat_buffer heard_;
  std::array<std::atomic<double>, 3> force_n_{};
  std::atomic<double> largest_n_{0.0};
  std::atomic<double> tremor_m_{0.0};
  std::atomic<bool> is_lost_{false};
  std::atomic<bool> has_second_{false};
  std::atomic<bool> has_forced_another_{false};
  std::atomic<bool> answers_every_other_{false};
  int asked_{0};
  int states_{0};
  std::thread thread_;
};
}  // namespace tapstudy::testing
