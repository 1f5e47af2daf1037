// stop_bench kill|stop STOPS PRIORITY: a program renders force with a SPIDAR-G6 on a bus that
// answers at once, and is killed or stopped at any moment; prints how long after the signal the
// kernel was given the packet of zero force, one number in nanoseconds a stop, or "none" after 1 s.
#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <random>
#include <string_view>

#include "device/loop/realtime.hpp"
#include "device/loop/tick_clock.hpp"
#include "device/usb/guardian.hpp"
#include "support/usb/spidar_on_bus.hpp"
using namespace tapstudy;
namespace {
constexpr device::Nanoseconds period = 1'000'000;
constexpr int first_ticks = 20;  // before a signal may come
constexpr int patience_ms = 1000;

[[noreturn]] void render(testing::FakeBus& bus, std::atomic<bool>& is_rendering, int priority) {
  const device::UsbNode node{testing::node_of(bus)};
  const auto board = device::board_of(device::sh4_product);
  const int above = priority > 0 ? priority + 1 : 0;
  device::Guardian guardian{node, {0x02, 0x86, board->zero_force_packet(), 0.02, above}};
  device::LibusbPipe pipe{node, {}, std::chrono::milliseconds{3}};
  device::SpidarSettings settings = testing::simulated_settings();
  settings.watchdog = &guardian.channel();
  device::SpidarG6 spidar{pipe, *board, settings};
  core::TickFault fault = core::TickFault::none;
  for (int step = 1; fault == core::TickFault::none && step <= 20; ++step) {
    fault = spidar.tighten(step / 20.0);
  }
  fault = fault == core::TickFault::none ? spidar.home() : fault;
  fault = fault == core::TickFault::none ? spidar.begin() : fault;
  device::ask_for_realtime({priority, true, {}});
  device::MonotonicClock clock;
  core::HandState hand;
  device::Nanoseconds deadline = clock.now();
  for (int tick = 0; fault == core::TickFault::none; ++tick) {
    deadline += period;
    clock.wait_until(deadline);
    fault = spidar.read(hand, 1e-3);
    fault = fault == core::TickFault::none ? spidar.write({0.0, 3.0, 0.0}) : fault;
    is_rendering = tick >= first_ticks;
  }
  std::_Exit(EXIT_FAILURE);
}

// Nanoseconds; negative: none came.
device::Nanoseconds time_to_zero(int signal, int priority, std::atomic<bool>& is_rendering,
                                 std::mt19937& random) {
  is_rendering = false;
  std::array<int, 2> zeroes{};
  if (pipe(zeroes.data()) != 0) {
    std::exit(EXIT_FAILURE);
  }
  // It outlives the program. What is sent other than an exchange of the program's is the
  // guardian's.
  testing::SimulatedSpidar hardware;
  testing::FakeBus bus{device::cyverse_vendor, device::sh4_product,
                       [&](auto request) { return hardware.answer(request); }};
  bus.forget_requests_as_they_come();
  bus.copy_plain_bulk_to(zeroes[1]);
  const pid_t program = fork();
  if (program == 0) {
    render(bus, is_rendering, priority);
  }
  while (!is_rendering) {
    if (waitpid(program, nullptr, WNOHANG) != 0) {  // a stall that it noticed itself
      close(zeroes[0]);
      close(zeroes[1]);
      return time_to_zero(signal, priority, is_rendering, random);
    }
    usleep(1000);
  }
  usleep(std::uniform_int_distribution<useconds_t>{0, 4000}(random));
  device::MonotonicClock clock;
  pollfd zero{zeroes[0], POLLIN, 0};
  const device::Nanoseconds before = clock.now();
  kill(program, signal);
  const bool has_come = poll(&zero, 1, patience_ms) > 0 && (zero.revents & POLLIN) != 0;
  const device::Nanoseconds after = clock.now();
  kill(program, SIGKILL);
  waitpid(program, nullptr, 0);
  close(zeroes[0]);
  close(zeroes[1]);
  return has_come ? after - before : -1;
}
}  // namespace

int main(int count, char** words) {
  if (count != 4) {
    return 2;
  }
  void* const shared = mmap(nullptr, sizeof(std::atomic<bool>), PROT_READ | PROT_WRITE,
                            MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  auto* const is_rendering = new (shared) std::atomic<bool>{false};
  const int priority = std::atoi(words[3]);
  if (priority > 0) {  // the bus answers whatever else runs
    device::ask_for_realtime({priority + 2, true, {}});
  }
  std::mt19937 random{1};  // NOLINT(bugprone-random-generator-seed): the moments need no secrecy
  for (int stop = 0; stop < std::atoi(words[2]); ++stop) {
    const int signal = std::string_view{words[1]} == "kill" ? SIGKILL : SIGSTOP;
    const device::Nanoseconds time = time_to_zero(signal, priority, *is_rendering, random);
    fmt::print("{}\n", time < 0 ? "none" : std::to_string(time));
  }
}
