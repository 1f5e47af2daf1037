#include "device/usb/guardian.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <csignal>

#include "device/spidar/sh4_board.hpp"
#include "support/usb/fake_bus.hpp"
using namespace tapstudy;
using testing::Bytes;
using testing::FakeBus;

namespace {
// Everything that arrives until all writers are gone.
Bytes all_from(int descriptor) {
  Bytes all;
  std::array<std::uint8_t, 512> some{};
  for (ssize_t count = 1; (count = read(descriptor, some.data(), some.size())) > 0;) {
    all.insert(all.end(), some.begin(), some.begin() + count);
  }
  return all;
}
}  // namespace

TEST_CASE("however the program dies, the last packets are of no force, three of them",
          "[device][usb][guardian]") {
  const int end = GENERATE(0, SIGKILL, SIGSEGV, SIGTERM, SIGABRT);
  std::array<int, 2> ends{};
  REQUIRE(pipe(ends.data()) == 0);
  FakeBus bus{device::cyverse_vendor, device::sh4_product,
              [](std::span<const std::uint8_t>) { return Bytes{}; }};
  bus.copy_plain_bulk_to(ends[1]);
  const pid_t program = fork();
  if (program == 0) {
    std::signal(SIGSEGV, SIG_DFL);
    std::signal(SIGABRT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    const device::UsbNode node{bus.open()};
    const auto zero_force_packet = device::Sh4Board::request({});
    {
      const device::Guardian guardian{
          node, 0x02, {zero_force_packet.begin(), zero_force_packet.end()}};
      if (end != 0) {
        kill(getpid(), end);
        pause();
      }
    }
    _exit(0);
  }
  close(ends[1]);
  int status = 0;
  REQUIRE(waitpid(program, &status, 0) == program);
  CHECK((end == 0 ? WIFEXITED(status) : WIFSIGNALED(status)));
  const Bytes sent = all_from(ends[0]);
  close(ends[0]);
  const auto zero_force_packet = device::Sh4Board::request({});
  REQUIRE(sent.size() == 3 * zero_force_packet.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    REQUIRE(sent[i] == zero_force_packet.at(i % zero_force_packet.size()));
  }
}

TEST_CASE("a program that stands still with force on loses it, and may find out",
          "[device][usb][guardian]") {
  const bool has_force = GENERATE(false, true);
  std::array<int, 2> ends{};
  REQUIRE(pipe(ends.data()) == 0);
  FakeBus bus{device::cyverse_vendor, device::sh4_product,
              [](std::span<const std::uint8_t>) { return Bytes{}; }};
  bus.copy_plain_bulk_to(ends[1]);
  const device::UsbNode node{bus.open()};
  const auto zero_force_packet = device::Sh4Board::request({});
  {
    device::Guardian guardian{node, 0x02, {zero_force_packet.begin(), zero_force_packet.end()}};
    if (has_force) {
      guardian.channel().begin();
    }
    while (guardian.channel().rounds() < 10 && !guardian.channel().has_acted()) {
      usleep(1000);
    }
    CHECK(guardian.channel().has_acted() == has_force);
  }
  close(ends[1]);
  const Bytes sent = all_from(ends[0]);
  close(ends[0]);
  CHECK(sent.size() == (has_force ? 6U : 3U) * zero_force_packet.size());  // and at the orderly end
}
