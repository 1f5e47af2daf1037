#pragma once
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <thread>

#include "device/remote/datagram_pipe.hpp"
#include "support/example_bridge.hpp"
#include "support/staged_loop.hpp"
namespace tapstudy::testing {
// To a real program at a port, in time that passes as the test tells: every reply comes so long
// after its request, however long the program took.
class PacedPipe final : public device::DatagramPipe {
 public:
  using Nanoseconds = device::Nanoseconds;
  explicit PacedPipe(std::uint16_t port) : inner_{device::open_udp_pipe(port)} {}
  Nanoseconds reply_delay{0};

  Nanoseconds now() noexcept override { return now_; }
  void wait_until(Nanoseconds moment) noexcept override { now_ = std::max(now_, moment); }
  device::DatagramOutcome send(std::span<const std::uint8_t> out) noexcept override {
    replies_at_ = now_ + reply_delay;
    return waited_for(inner_->send(out));
  }
  device::ReceivedDatagram receive(std::span<std::uint8_t> in,
                                   Nanoseconds deadline) noexcept override {
    if (replies_at_ > deadline) {
      now_ = deadline;
      return {device::DatagramOutcome::timed_out, 0};
    }
    now_ = std::max(now_, replies_at_);
    const std::chrono::nanoseconds patience = unhurried;
    device::ReceivedDatagram received = inner_->receive(in, inner_->now() + patience.count());
    received.outcome = waited_for(received.outcome);
    return received;
  }

 private:
  // A program that has just been started takes its time.
  static device::DatagramOutcome waited_for(device::DatagramOutcome outcome) {
    if (outcome == device::DatagramOutcome::gone) {
      std::this_thread::sleep_for(std::chrono::milliseconds{100});
    }
    return outcome;
  }
  std::unique_ptr<device::DatagramPipe> inner_;
  Nanoseconds now_{0};
  Nanoseconds replies_at_{0};
};

using PacedClock = ClockOf<PacedPipe>;
}  // namespace tapstudy::testing
