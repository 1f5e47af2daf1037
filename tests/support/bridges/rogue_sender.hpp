#pragma once
#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>

#include "device/remote/packets.hpp"
#include "support/catch.hpp"
#include "support/example_bridge.hpp"
namespace tapstudy::testing {
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
  void send(const core::Vec3& force_n) {
    ask(4'000'000'000U, force_n);
    static_cast<void>(::send(socket_, "nonsense", 8, 0));
  }
  void ask(std::uint32_t number, const core::Vec3& force_n,
           device::wire::Asked asked = device::wire::Asked::exchange) {
    const auto bytes = device::encoded(device::wire::Request{
        .asked = asked, .number = number, .force_n = {force_n.x(), force_n.y(), force_n.z()}});
    static_cast<void>(::send(socket_, bytes.data(), bytes.size(), 0));
  }
  // None if there is none in time, or what comes is no reply to an exchange.
  std::optional<device::RemoteReply> next_reply(std::chrono::milliseconds patience = unhurried) {
    pollfd waiting{socket_, POLLIN, 0};
    std::array<std::uint8_t, 300> reply{};
    poll(&waiting, 1, static_cast<int>(patience.count()));
    const ssize_t count = recv(socket_, reply.data(), reply.size(), MSG_DONTWAIT);
    return count < 0
               ? std::nullopt
               : device::decoded_reply(std::span{reply}.first(static_cast<std::size_t>(count)));
  }

 private:
  int socket_{socket(AF_INET, SOCK_DGRAM, 0)};
};
}  // namespace tapstudy::testing
