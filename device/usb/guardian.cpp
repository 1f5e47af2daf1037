#include "device/usb/guardian.hpp"

#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <memory>

#include "device/device.hpp"
namespace tapstudy::device {
namespace {
constexpr unsigned time_out_ms = 100;
constexpr int round_ms = 20;
constexpr int max_still_rounds = 5;

// Uses only async-signal-safe functions, as required between fork and _exit.
class Watchdog {
 public:
  Watchdog(int life, int node, std::uint8_t endpoint, std::vector<std::uint8_t>& zero_force_packet,
           WatchdogChannel& channel) noexcept
      : life_{life},
        node_{node},
        endpoint_{endpoint},
        zero_force_packet_{zero_force_packet},
        channel_{channel} {}

  [[noreturn]] void run() noexcept {
    for (const int signal : std::array{SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE}) {
      struct sigaction ignored {};
      ignored.sa_handler = SIG_IGN;
      sigaction(signal, &ignored, nullptr);
    }
    while (lives_on()) {
      poll();
      channel_.complete_round();
    }
    send_zero_force();
    _exit(0);
  }

 private:
  // Waits for one polling cycle; false once the pipe is closed.
  bool lives_on() const noexcept {
    pollfd waiting{life_, POLLIN, 0};
    if (::poll(&waiting, 1, round_ms) <= 0) {
      return true;
    }
    char byte = 0;
    return read(life_, &byte, 1) != 0;
  }
  void poll() noexcept {
    const std::uint64_t beats = channel_.beats();
    still_rounds_ = channel_.is_on() && beats == beats_ ? still_rounds_ + 1 : 0;
    beats_ = beats;
    if (still_rounds_ == max_still_rounds) {
      channel_.act();  // first: a resumed program must see it before sending
      send_zero_force();
    }
  }
  void send_zero_force() noexcept {
    for (int i = 0; i < zero_force_packets; ++i) {
      usbdevfs_bulktransfer packet{endpoint_, static_cast<unsigned>(zero_force_packet_.size()),
                                   time_out_ms, zero_force_packet_.data()};
      ioctl(node_, USBDEVFS_BULK, &packet);  // NOLINT(cppcoreguidelines-pro-type-vararg)
    }
  }

  int life_;
  int node_;
  std::uint8_t endpoint_;
  std::vector<std::uint8_t>& zero_force_packet_;
  WatchdogChannel& channel_;
  std::uint64_t beats_{0};
  int still_rounds_{0};
};
}  // namespace

void Guardian::Unmap::operator()(WatchdogChannel* channel) const noexcept {
  munmap(channel, sizeof(WatchdogChannel));
}

std::unique_ptr<WatchdogChannel, Guardian::Unmap> Guardian::shared_channel() {
  void* const memory = mmap(nullptr, sizeof(WatchdogChannel), PROT_READ | PROT_WRITE,
                            MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) {  // NOLINT(cppcoreguidelines-pro-type-cstyle-cast): the C library's
    throw DeviceError{"no shared memory for the device's guardian"};
  }
  return std::unique_ptr<WatchdogChannel, Unmap>{
      std::construct_at(static_cast<WatchdogChannel*>(memory))};
}
Guardian::Guardian(const UsbNode& node, std::uint8_t out_endpoint,
                   std::vector<std::uint8_t> zero_force_packet)
    : channel_{shared_channel()} {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw DeviceError{"no pipe for the device's guardian"};
  }
  child_ = fork();
  if (child_ == 0) {
    setsid();  // detached from Ctrl-C at the terminal
    close(ends[1]);
    Watchdog{ends[0], node.descriptor(), out_endpoint, zero_force_packet, *channel_}.run();
  }
  close(ends[0]);
  life_ = ends[1];
  if (child_ < 0) {
    close(life_);
    throw DeviceError{"the device's guardian cannot be started"};
  }
}

Guardian::~Guardian() {
  close(life_);
  int status = 0;
  while (waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
}
}  // namespace tapstudy::device
