#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <system_error>

#include "device/device.hpp"
#include "device/remote/datagram_pipe.hpp"
namespace tapstudy::device {
namespace {
class UdpPipe final : public DatagramPipe {
 public:
  explicit UdpPipe(std::uint16_t port)
      : socket_{socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)} {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const auto generic = std::bit_cast<sockaddr>(address);
    if (socket_ < 0 || connect(socket_, &generic, sizeof generic) != 0) {
      const std::error_code cause{errno, std::generic_category()};
      close(socket_);
      throw DeviceError{
          fmt::format("remote: no socket for UDP port {}: {}", port, cause.message())};
    }
  }
  ~UdpPipe() override { close(socket_); }
  UdpPipe(const UdpPipe& other) = delete;
  UdpPipe& operator=(const UdpPipe& other) = delete;
  UdpPipe(UdpPipe&& other) = delete;
  UdpPipe& operator=(UdpPipe&& other) = delete;

  Nanoseconds now() noexcept override { return clock_.now(); }
  void wait_until(Nanoseconds moment) noexcept override { clock_.wait_until(moment); }

  DatagramOutcome send(std::span<const std::uint8_t> out) noexcept override {
    if (::send(socket_, out.data(), out.size(), 0) == static_cast<ssize_t>(out.size())) {
      return DatagramOutcome::ok;
    }
    return errno == ECONNREFUSED ? DatagramOutcome::gone : DatagramOutcome::failed;
  }

  ReceivedDatagram receive(std::span<std::uint8_t> in, Nanoseconds deadline) noexcept override {
    while (is_readable_by(deadline)) {
      const ssize_t count = recv(socket_, in.data(), in.size(), 0);
      if (count >= 0) {
        return {DatagramOutcome::ok, static_cast<std::size_t>(count)};
      }
      if (errno == ECONNREFUSED) {
        return {DatagramOutcome::gone, 0};
      }
    }
    return {DatagramOutcome::timed_out, 0};
  }

 private:
  // Or a signal has come, which ends the wait, not the time: then nothing can be read yet.
  bool is_readable_by(Nanoseconds deadline) noexcept {
    constexpr Nanoseconds second = 1'000'000'000;
    const Nanoseconds left = deadline - now();
    if (left <= 0) {
      return false;
    }
    pollfd waiting{socket_, POLLIN, 0};
    const timespec time_left{left / second, left % second};
    return ppoll(&waiting, 1, &time_left, nullptr) != 0;
  }

  int socket_;
  MonotonicClock clock_;
};
}  // namespace

std::unique_ptr<DatagramPipe> open_udp_pipe(std::uint16_t port) {
  return std::make_unique<UdpPipe>(port);
}
}  // namespace tapstudy::device
