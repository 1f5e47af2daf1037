#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "device/usb/usb_pipe.hpp"
#include "support/usb/simulated_spidar.hpp"
namespace tapstudy::testing {
// What a SPIDAR that is moved about replies, made before anything is timed.
inline std::vector<Bytes> replies_of_a_moving_grip() {
  constexpr std::size_t kept_replies = 4096;
  SimulatedSpidar hardware;
  std::vector<Bytes> all;
  std::vector<std::uint8_t> request(512, 0);
  request[0] = 0x01;
  request[1] = 0x0E;
  for (std::size_t i = 0; i < kept_replies; ++i) {
    const double turn = 2.0 * M_PI * static_cast<double>(i) / kept_replies;
    hardware.hold_at({0.015 * std::sin(turn), 0.01 * std::sin(2.0 * turn), 0.0});
    all.push_back(hardware.answer(request));
  }
  return all;
}

// Echoes the request, as the board does.
inline Bytes with_echo(Bytes reply, std::span<const std::uint8_t> request) {
  std::copy_n(request.begin() + 2, 16, reply.begin());
  return reply;
}

// A board without a bus: it answers at once, out of memory that was taken before.
class PlayedBack final : public device::UsbPipe {
 public:
  device::UsbOutcome send(std::span<const std::uint8_t> /*out*/) noexcept override {
    return device::UsbOutcome::ok;
  }
  device::UsbOutcome exchange(std::span<const std::uint8_t> out,
                              std::span<std::uint8_t> in) noexcept override {
    std::ranges::copy(replies_[next_++ % replies_.size()], in.begin());
    std::copy_n(out.begin() + 2, 16, in.begin());
    return device::UsbOutcome::ok;
  }
  void drain() noexcept override {}

 private:
  std::vector<Bytes> replies_{replies_of_a_moving_grip()};
  std::size_t next_{0};
};
}  // namespace tapstudy::testing
