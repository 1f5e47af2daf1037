#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "device/loop/tick_clock.hpp"
namespace tapstudy::device {
enum class DatagramOutcome : std::uint8_t {
  ok,
  timed_out,  // no datagram in time
  gone,       // nobody listens at the port
  failed
};
struct ReceivedDatagram {
  DatagramOutcome outcome{};
  std::size_t bytes{};  // more than the buffer holds are cut off
};

// Datagrams to and from one other program, and the time in which they are waited for. Does not
// throw once it is open.
class DatagramPipe {
 public:
  virtual ~DatagramPipe() = default;
  virtual Nanoseconds now() noexcept = 0;
  virtual void wait_until(Nanoseconds moment) noexcept = 0;
  // ok: all of it is on its way.
  [[nodiscard]] virtual DatagramOutcome send(std::span<const std::uint8_t> out) noexcept = 0;
  // Waits for the next datagram, until the deadline at most.
  [[nodiscard]] virtual ReceivedDatagram receive(std::span<std::uint8_t> in,
                                                 Nanoseconds deadline) noexcept = 0;
};

// A socket connected to a port of the loopback, in real time. Throws DeviceError if it cannot be
// opened.
std::unique_ptr<DatagramPipe> open_udp_pipe(std::uint16_t port);
}  // namespace tapstudy::device
