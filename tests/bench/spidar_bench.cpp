// A tick of a SPIDAR-G6: what it computes, and the whole of it through the real libusb over a bus
// that answers at once; each with and without a guardian that watches it.
#include <benchmark/benchmark.h>

#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "device/usb/guardian.hpp"
#include "support/usb/played_back.hpp"
#include "support/usb/spidar_on_bus.hpp"
using namespace tapstudy;
namespace {
// Whether the guardian is alive is asked once, in real time.
core::TickFault begin(device::SpidarG6& spidar, device::WatchdogChannel& channel) {
  const std::jthread guardian{[&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      channel.complete_round();
      std::this_thread::sleep_for(std::chrono::milliseconds{1});
    }
  }};
  return spidar.begin();
}

void run(benchmark::State& state, device::UsbPipe& pipe) {
  constexpr int ticks_a_round = 2;  // at 1 kHz
  const auto board = device::board_of(device::sh4_product);
  device::WatchdogChannel channel;
  device::SpidarSettings settings = testing::simulated_settings();
  settings.watchdog = state.range(0) != 0 ? &channel : nullptr;
  device::SpidarG6 spidar{pipe, *board, settings};
  if (spidar.home() != core::TickFault::none || begin(spidar, channel) != core::TickFault::none) {
    state.SkipWithError("cannot begin");
  }
  core::HandState hand;
  int tick = 0;
  for (auto _ : state) {
    const double turn = 0.01 * ++tick;
    if (tick % ticks_a_round == 0) {
      channel.complete_round();
    }
    if (spidar.read(hand, 1e-3) != core::TickFault::none ||
        spidar.write({2.0 * std::sin(turn), 3.0 * std::cos(turn), 1.0}) != core::TickFault::none) {
      state.SkipWithError("a tick failed");
      break;
    }
  }
}

void spidar_tick_computed(benchmark::State& state) {
  testing::PlayedBack pipe;
  run(state, pipe);
}

void spidar_tick_through_libusb(benchmark::State& state) {
  const std::vector<testing::Bytes> all = testing::replies_of_a_moving_grip();
  std::size_t next = 0;
  testing::FakeBus bus{device::cyverse_vendor, device::sh4_product, [&](auto request) {
                         testing::Bytes reply = all[next++ % all.size()];
                         testing::echo(request, reply);
                         return reply;
                       }};
  bus.forget_requests_as_they_come();
  const device::UsbNode node{testing::node_of(bus)};
  device::LibusbPipe pipe{node, {}, std::chrono::milliseconds{100}, testing::FakeBus::now};
  run(state, pipe);
}
}  // namespace
BENCHMARK(spidar_tick_computed)->ArgName("watched")->Arg(0)->Arg(1);
BENCHMARK(spidar_tick_through_libusb)->ArgName("watched")->Arg(0)->Arg(1);
BENCHMARK_MAIN();
