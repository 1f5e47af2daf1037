#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
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

// Echoes the request and gives the motors its voltages, as the board does.
inline void echo(std::span<const std::uint8_t> request, std::span<std::uint8_t> reply) {
  std::copy_n(request.begin() + 2, 16, reply.begin());
  std::copy_n(request.begin() + 2, 16, reply.begin() + 32);
}

// A board without a bus: it answers at once, out of memory that was taken before.
class PlayedBack final : public device::UsbPipe {
 public:
  device::UsbOutcome send(std::span<const std::uint8_t> /*out*/) noexcept override {
    return device::UsbOutcome::ok;
  }
  device::UsbOutcome exchange(std::span<const std::uint8_t> out,
                              std::span<std::uint8_t> in) noexcept override {
    if (meanwhile_) {
      meanwhile_();
    }
    if (fails_) {
      return device::UsbOutcome::stalled;
    }
    std::ranges::copy(replies_[next_++ % replies_.size()], in.begin());
    echo(out, in);
    return device::UsbOutcome::ok;
  }
  device::UsbOutcome receive(std::span<std::uint8_t> /*in*/) noexcept override {
    return device::UsbOutcome::timed_out;
  }
  void clear_halt() noexcept override {}
  void drain() noexcept override {}
  void fail_from_now_on() { fails_ = true; }
  void in_the_middle_of_an_exchange(std::function<void()> meanwhile) {
    meanwhile_ = std::move(meanwhile);
  }

 private:
  bool fails_{false};
  std::function<void()> meanwhile_;
  std::vector<Bytes> replies_{replies_of_a_moving_grip()};
  std::size_t next_{0};
};
}  // namespace tapstudy::testing
