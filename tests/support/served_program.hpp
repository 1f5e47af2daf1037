#pragma once
#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <span>
#include <thread>

#include "support/catch.hpp"
#include "support/remote_program.hpp"
namespace tapstudy::testing {
// A RemoteProgram at a port of the loopback, in real time, that lets go 20 ms after the last
// datagram.
class ServedProgram {
 public:
  explicit ServedProgram(int version) : program_{version} {
    program_.release_after = 20'000'000;
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    REQUIRE(bind(socket_, as_generic(address), size) == 0);
    REQUIRE(getsockname(socket_, as_generic(address), &size) == 0);
    port_ = ntohs(address.sin_port);
    serving_ = std::jthread{[this](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        serve();
      }
    }};
  }
  ~ServedProgram() {
    serving_ = {};
    close(socket_);
    close(impostor_);
  }
  ServedProgram(const ServedProgram&) = delete;
  ServedProgram& operator=(const ServedProgram&) = delete;
  ServedProgram(ServedProgram&&) = delete;
  ServedProgram& operator=(ServedProgram&&) = delete;
  std::uint16_t port() const { return port_; }
  double exerted_n() const { return exerted_n_; }
  double height_m() const { return program_.height_m; }
  // Another program answers each request as well, before this one, with the same reply but
  // for the height.
  std::atomic<bool> has_impostor{false};

 private:
  static sockaddr* as_generic(sockaddr_in& address) {
    return reinterpret_cast<sockaddr*>(&address);  // NOLINT: sockets take them in no other way
  }
  void serve() {
    constexpr int round_ms = 1;
    pollfd waiting{socket_, POLLIN, 0};
    poll(&waiting, 1, round_ms);
    const std::chrono::nanoseconds passed = std::chrono::steady_clock::now() - began_;
    program_.wait_until(passed.count());
    std::array<std::uint8_t, 300> bytes{};
    sockaddr_in sender{};
    socklen_t size = sizeof sender;
    const ssize_t count =
        recvfrom(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT, as_generic(sender), &size);
    if (count > 0) {
      static_cast<void>(program_.send(std::span{bytes}.first(static_cast<std::size_t>(count))));
      answer(sender);
    }
    exerted_n_ = program_.exerted_n;
  }
  void answer(sockaddr_in& sender) {
    std::array<std::uint8_t, 300> reply{};
    for (device::ReceivedDatagram one = program_.receive(reply, program_.now());
         one.outcome == device::DatagramOutcome::ok;
         one = program_.receive(reply, program_.now())) {
      if (has_impostor) {
        std::array<std::uint8_t, 300> forged = reply;
        const std::size_t height_at = program_.version == 3 ? 32 : 20;
        forged.at(height_at + sizeof(double) - 2) ^= 0x10U;
        sendto(impostor_, forged.data(), one.bytes, 0, as_generic(sender), sizeof sender);
      }
      sendto(socket_, reply.data(), one.bytes, 0, as_generic(sender), sizeof sender);
    }
  }

  RemoteProgram program_;
  std::chrono::steady_clock::time_point began_{std::chrono::steady_clock::now()};
  int socket_{socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  int impostor_{socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  std::uint16_t port_{0};
  std::atomic<double> exerted_n_{0.0};
  std::jthread serving_;
};
}  // namespace tapstudy::testing
