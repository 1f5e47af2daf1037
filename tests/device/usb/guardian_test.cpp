#include "device/usb/guardian.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "device/relay/serial_port.hpp"
#include "device/spidar/board.hpp"
#include "device/usb/libusb_pipe.hpp"
#include "support/catch.hpp"
#include "support/usb/fake_bus.hpp"
using namespace tapstudy;
using testing::Bytes;
using testing::FakeBus;

namespace {
constexpr double four_rounds_s = 4e-3 * device::guardian_round_ms;
// For a test that beats: a busy machine may keep it from doing so for long.
constexpr double long_stall_s = 1.0;

device::GuardianSettings settings(double max_stall_s = four_rounds_s) {
  return {0x02, 0x86, device::Sh4Board{}.zero_force_packet(), max_stall_s, 0};
}

// Echoes what it was sent, as an SH4 board does, or one count more.
Bytes echo(std::span<const std::uint8_t> request, bool is_right) {
  Bytes reply(512, 0);
  std::copy_n(request.begin() + 2, 16, reply.begin());
  reply[0] = static_cast<std::uint8_t>(reply[0] + (is_right ? 0 : 1));
  return reply;
}

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
    {
      const device::Guardian guardian{node, settings()};
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

namespace {
// A board whose plain bulk packets come out of a pipe, and a guardian for it.
struct Watched {
  std::array<int, 2> ends{};
  std::atomic<bool> echoes_rightly{true};
  FakeBus bus{
      device::cyverse_vendor, device::sh4_product,
      [this](std::span<const std::uint8_t> request) { return echo(request, echoes_rightly); }};
  std::optional<device::UsbNode> node;
  std::optional<device::Guardian> guardian;

  Watched() {
    REQUIRE(pipe2(ends.data(), O_NONBLOCK) == 0);
    bus.copy_plain_bulk_to(ends[1]);
    node.emplace(bus.open());
  }
  ~Watched() {
    guardian.reset();
    close(ends[0]);
    close(ends[1]);
  }
  Watched(const Watched&) = delete;
  Watched& operator=(const Watched&) = delete;
  Watched(Watched&&) = delete;
  Watched& operator=(Watched&&) = delete;

  device::WatchdogChannel& watch(double max_stall_s = four_rounds_s, int relay = -1) {
    device::GuardianSettings with_relay = settings(max_stall_s);
    with_relay.relay = relay;
    guardian.emplace(*node, with_relay);
    return guardian->channel();
  }
  void pass_rounds(std::uint64_t count) {
    const std::uint64_t from = guardian->channel().rounds();
    while (guardian->channel().rounds() < from + count) {
      usleep(1000);
    }
  }
  // Since asked before.
  std::size_t packets() {
    std::array<std::uint8_t, 512> packet{};
    std::size_t count = 0;
    while (read(ends[0], packet.data(), packet.size()) > 0) {
      ++count;
    }
    return count;
  }
  // Since asked before, as soon as there are so many; it may take long where the machine is busy.
  std::size_t at_least(std::size_t wanted) {
    std::size_t count = packets();
    for (int i = 0; i < 20'000 && count < wanted; ++i) {
      usleep(1000);
      count += packets();
    }
    return count;
  }
  // Until it has ended: nobody else writes to the pipe.
  std::size_t packets_of_the_end() {
    guardian.reset();
    close(std::exchange(ends[1], -1));
    REQUIRE(fcntl(ends[0], F_SETFL, 0) == 0);
    return packets();
  }
};
}  // namespace

TEST_CASE("a program that stands still with force on loses it, every round anew, and may find out",
          "[device][usb][guardian]") {
  Watched watched;
  device::WatchdogChannel& watch = watched.watch();
  watched.pass_rounds(10);
  CHECK_FALSE(watch.has_acted());
  CHECK(watched.packets() == 0);
  watch.begin();
  watched.pass_rounds(10);  // four without a beat
  CHECK(watch.has_acted());
  CHECK_FALSE(watch.claim_output());
  CHECK(watched.packets() >= 5);
  // continued, and stopped again before its next beat: it may have sent one packet
  watched.pass_rounds(10);
  CHECK(watched.packets() >= 9);
}

TEST_CASE(
    "a guardian asked to repeat zero force clears a halted endpoint and tells when it is confirmed",
    "[device][usb][guardian][safety]") {
  const int clears = GENERATE(0, 1, 1'000'000);
  Watched watched;
  watched.bus.halt_out(clears);
  device::WatchdogChannel& watch = watched.watch(long_stall_s);
  watch.begin();
  watch.repeat_zero_force();
  for (int i = 0; i < 10; ++i) {
    watch.beat();
    watched.pass_rounds(1);
  }
  CHECK(watch.is_zero_confirmed() == (clears < 2));
  CHECK((watched.packets() > 5) == (clears < 2));
  CHECK_FALSE(watch.has_acted());
  watch.end();
  watched.pass_rounds(2);
  watched.packets();
  watched.pass_rounds(5);
  CHECK(watched.packets() == 0);
}

TEST_CASE(
    "while the program stops the board itself its guardian sends nothing, unless it stands still",
    "[device][usb][guardian][safety]") {
  const bool stands_still = GENERATE(false, true);
  Watched watched;
  device::WatchdogChannel& watch = watched.watch(stands_still ? four_rounds_s : long_stall_s);
  watch.begin();
  watch.repeat_zero_force();
  REQUIRE(watched.at_least(1) > 0);
  watch.pause_repeating(true);
  watched.pass_rounds(2);
  watched.packets();
  for (int i = 0; i < 10; ++i) {
    stands_still ? void() : watch.beat();
    watched.pass_rounds(1);
  }
  CHECK((watched.packets() > 0) == stands_still);
  CHECK_FALSE(watch.may_close_relay());
  watch.pause_repeating(false);
  CHECK(watched.at_least(1) > 0);
}

TEST_CASE("nothing but a whole reply that carries the zeros, and is not from before, confirms them",
          "[device][usb][guardian][safety]") {
  using Trouble = FakeBus::Trouble;
  Watched watched;
  device::LibusbPipe pipe{*watched.node, {}, std::chrono::milliseconds{25}, testing::FakeBus::now};
  const device::Sh4Board::Packet zeros = device::Sh4Board::request({});
  for (int i = 0; i < 3; ++i) {  // their replies are left over
    REQUIRE(pipe.send(zeros) == device::UsbOutcome::ok);
  }
  SECTION("none comes any more") {
    watched.bus.persist_in(GENERATE(Trouble::missing, Trouble::out_lost));
  }
  SECTION("half a reply comes") {
    watched.bus.persist_in(Trouble::short_reply);
  }
  SECTION("it echoes something else") {
    watched.echoes_rightly = false;
  }
  device::WatchdogChannel& watch = watched.watch(long_stall_s);
  watch.repeat_zero_force();
  watched.pass_rounds(10);
  CHECK_FALSE(watch.is_zero_confirmed());
  watched.bus.persist_in(Trouble::none);
  watched.echoes_rightly = true;
  for (int i = 0; i < 1000 && !watch.is_zero_confirmed(); ++i) {
    watched.pass_rounds(1);
  }
  CHECK(watch.is_zero_confirmed());
}

TEST_CASE("a guardian left alone with a board that had force repeats zero force until it replies",
          "[device][usb][guardian][safety]") {
  Watched watched;
  watched.watch().allow_power();
  watched.bus.persist_in(FakeBus::Trouble::out_lost);
  watched.guardian.reset();
  CHECK(watched.at_least(10) >= 10);
  CHECK(watched.bus.requests().empty());
  watched.bus.persist_in(FakeBus::Trouble::none);
  CHECK(watched.packets_of_the_end() >= 1);
  CHECK_FALSE(watched.bus.requests().empty());
}

TEST_CASE("a guardian left alone repeats zero force until it is taken, three times",
          "[device][usb][guardian][safety]") {
  Watched watched;
  watched.bus.halt_out(20);  // longer than three attempts
  static_cast<void>(watched.watch());
  CHECK(watched.packets_of_the_end() == 3);
}

TEST_CASE("a program stopped, continued and stopped again cannot leave its force on",
          "[device][usb][guardian][safety]") {
  Watched watched;
  const pid_t program = fork();
  if (program == 0) {
    {
      device::WatchdogChannel& watch = watched.watch();
      watch.begin();
      raise(SIGSTOP);  // with a packet in hand
      raise(SIGSTOP);  // just after it went out
      pause();
    }
    _exit(0);
  }
  int status = 0;
  for (int stop = 0; stop < 2; ++stop) {
    REQUIRE(waitpid(program, &status, WUNTRACED) == program);
    REQUIRE(WIFSTOPPED(status));
    CHECK(watched.at_least(3) >= 3);
    kill(program, SIGCONT);
  }
  kill(program, SIGKILL);
  waitpid(program, &status, 0);
}

TEST_CASE("a kernel short of memory takes the program before its guardian",
          "[device][usb][guardian]") {
  Watched watched;
  const pid_t program = fork();
  if (program == 0) {
    static_cast<void>(watched.watch());
    std::ifstream score{"/proc/self/oom_score_adj"};
    int value = 0;
    score >> value;
    _exit(value == 500 ? 0 : 1);
  }
  int status = 0;
  REQUIRE(waitpid(program, &status, 0) == program);
  CHECK(WEXITSTATUS(status) == 0);
}

namespace {
// A serial port: what is written to it comes out here.
struct SerialPort {
  int far_end{};
  std::string name;
  SerialPort() : far_end{posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)} {
    REQUIRE((far_end >= 0 && grantpt(far_end) == 0 && unlockpt(far_end) == 0));
    name = ptsname(far_end);
  }
  ~SerialPort() { close(far_end); }
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;
  SerialPort(SerialPort&&) = delete;
  SerialPort& operator=(SerialPort&&) = delete;
  // Since asked before. What was written comes out a while later, and before a mark of the test's
  // own, which may be discarded on its way.
  std::size_t signs_of_life(const device::DeadManRelay& relay) {
    mark_ = static_cast<char>('a' + (mark_ - 'a' + 1) % 26);
    std::size_t signs = 0;
    for (int i = 0;; ++i) {
      if (i % 100 == 0) {
        REQUIRE(write(relay.descriptor(), &mark_, 1) == 1);
      }
      std::array<char, 4096> bytes{};
      const ssize_t count = read(far_end, bytes.data(), bytes.size());
      const std::string_view read{bytes.data(),
                                  static_cast<std::size_t>(std::max<ssize_t>(0, count))};
      signs += static_cast<std::size_t>(std::ranges::count(read, sign_of_life));
      if (read.find(mark_) != std::string_view::npos) {
        return signs;
      }
      usleep(1000);
    }
  }

 private:
  static constexpr char sign_of_life = 0x55;
  char mark_{'a'};
};
}  // namespace

TEST_CASE("a relay is kept closed while all is well, and by nothing else",
          "[device][usb][guardian][safety]") {
  SerialPort port;
  Watched watched;
  const device::DeadManRelay relay{port.name};
  device::WatchdogChannel& watch = watched.watch(long_stall_s, relay.descriptor());
  const auto signs_of_fifty_rounds = [&](bool beats) {
    watched.pass_rounds(1);
    static_cast<void>(port.signs_of_life(relay));
    for (int i = 0; i < 50; ++i) {
      beats ? watch.beat() : void();
      watched.pass_rounds(1);
    }
    return port.signs_of_life(relay);
  };
  CHECK(signs_of_fifty_rounds(false) == 0);  // zero force is not confirmed yet
  watch.allow_power();
  CHECK(signs_of_fifty_rounds(false) >= 9);  // at rest nobody need beat
  watch.begin();
  CHECK(signs_of_fifty_rounds(true) >= 9);
  SECTION("a stop that is not confirmed opens it, until it is") {
    watch.repeat_zero_force();
    CHECK(signs_of_fifty_rounds(true) <= 1);
    watch.end();
    CHECK(signs_of_fifty_rounds(false) >= 9);
  }
  SECTION("a program that stands still opens it for good") {
    watched.pass_rounds(static_cast<std::uint64_t>(1e3 * long_stall_s) / device::guardian_round_ms +
                        10);
    CHECK(signs_of_fifty_rounds(false) == 0);
    CHECK(signs_of_fifty_rounds(true) == 0);
  }
  SECTION("without a guardian nobody holds it") {
    CHECK(watched.packets_of_the_end() == 3);
    static_cast<void>(port.signs_of_life(relay));
    CHECK(port.signs_of_life(relay) == 0);
  }
}

TEST_CASE("a port that is none, or is another's, is refused", "[device][guardian]") {
  const SerialPort port;
  const device::DeadManRelay relay{port.name};
  CHECK_THROWS_WITH(device::DeadManRelay{port.name}, Contains("another session"));
  CHECK_THROWS_WITH(device::DeadManRelay{"/dev/null"}, Contains("not a serial port"));
  CHECK_THROWS_WITH(device::DeadManRelay{"/dev/ttyNone"},
                    Contains("cannot be opened: No such file"));
}

namespace {
// A listening socket; -1 if the port is taken. port 0: any.
int listening_at(std::uint16_t port) {
  const int descriptor = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const auto generic = std::bit_cast<sockaddr>(address);
  if (bind(descriptor, &generic, sizeof generic) != 0 || listen(descriptor, 1) != 0) {
    close(descriptor);
    return -1;
  }
  return descriptor;
}
std::uint16_t port_of(int descriptor) {
  sockaddr generic{};
  socklen_t size = sizeof generic;
  REQUIRE(getsockname(descriptor, &generic, &size) == 0);
  return ntohs(std::bit_cast<sockaddr_in>(generic).sin_port);
}
}  // namespace

TEST_CASE("a child that outlives its program does not keep the port that it inherited",
          "[device][safety]") {
  const int listening = listening_at(0);
  const std::uint16_t port = port_of(listening);
  std::array<int, 2> closed{};
  REQUIRE(pipe(closed.data()) == 0);
  const pid_t child = fork();
  if (child == 0) {
    device::close_files_and_named_sockets({});
    static_cast<void>(!write(closed[1], "c", 1));  // the pipe is no socket, and stays
    pause();
    _exit(0);
  }
  char byte = 0;
  REQUIRE(read(closed[0], &byte, 1) == 1);
  close(listening);
  const int again = listening_at(port);
  CHECK(again >= 0);
  close(again);
  kill(child, SIGKILL);
  CHECK(waitpid(child, nullptr, 0) == child);
  close(closed[0]);
  close(closed[1]);
}

TEST_CASE("a guardian that is started while its program holds a file locked does not keep the lock",
          "[device][guardian][safety]") {
  std::string name{"/tmp/tapstudy_lock_XXXXXX"};
  const int locked = mkstemp(name.data());
  REQUIRE(flock(locked, LOCK_EX) == 0);
  Watched watched;
  watched.guardian.emplace(*watched.node, settings());
  while (watched.guardian->channel().rounds() == 0) {
    usleep(1000);
  }
  close(locked);
  const int again = open(name.c_str(), O_RDWR);
  CHECK(flock(again, LOCK_EX | LOCK_NB) == 0);
  close(again);
  unlink(name.c_str());
}
