// A tick of a SPIDAR-G6: what it computes, and the whole of it through the real libusb over a bus
// that answers at once.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "support/usb/spidar_on_bus.hpp"
using namespace tapstudy;
using testing::SimulatedSpidar;
namespace {
constexpr std::size_t kept_replies = 4096;

// What a SPIDAR that is moved about replies, made before anything is timed.
std::vector<testing::Bytes> replies() {
  SimulatedSpidar hardware;
  std::vector<testing::Bytes> all;
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
testing::Bytes with_echo(testing::Bytes reply, std::span<const std::uint8_t> request) {
  std::copy_n(request.begin() + 2, 16, reply.begin());
  return reply;
}

class PlayedBack final : public device::UsbPipe {
 public:
  device::UsbOutcome send(std::span<const std::uint8_t> /*out*/) noexcept override {
    return device::UsbOutcome::ok;
  }
  device::UsbOutcome exchange(std::span<const std::uint8_t> out,
                              std::span<std::uint8_t> in) noexcept override {
    std::ranges::copy(replies_[next_++ % kept_replies], in.begin());
    std::copy_n(out.begin() + 2, 16, in.begin());
    return device::UsbOutcome::ok;
  }
  void drain() noexcept override {}

 private:
  std::vector<testing::Bytes> replies_{replies()};
  std::size_t next_{0};
};

void run(benchmark::State& state, device::UsbPipe& pipe) {
  const auto board = device::board_of(device::sh4_product);
  device::SpidarG6 spidar{pipe, *board, testing::simulated_settings()};
  if (spidar.home() != core::TickFault::none) {
    state.SkipWithError("cannot be homed");
  }
  core::HandState hand;
  int tick = 0;
  for (auto _ : state) {
    const double turn = 0.01 * ++tick;
    if (spidar.read(hand) != core::TickFault::none ||
        spidar.write({2.0 * std::sin(turn), 3.0 * std::cos(turn), 1.0}) != core::TickFault::none) {
      state.SkipWithError("a tick failed");
      break;
    }
  }
}

void spidar_tick_computed(benchmark::State& state) {
  PlayedBack pipe;
  run(state, pipe);
}

void spidar_tick_through_libusb(benchmark::State& state) {
  const std::vector<testing::Bytes> all = replies();
  std::size_t next = 0;
  testing::FakeBus bus{device::cyverse_vendor, device::sh4_product, [&](auto request) {
                         return with_echo(all[next++ % kept_replies], request);
                       }};
  bus.forget_requests_as_they_come();
  const device::UsbNode node{testing::node_of(bus)};
  device::LibusbPipe pipe{node, {}, std::chrono::milliseconds{100}};
  run(state, pipe);
}
}  // namespace
BENCHMARK(spidar_tick_computed);
BENCHMARK(spidar_tick_through_libusb);
BENCHMARK_MAIN();
