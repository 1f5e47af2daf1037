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
constexpr int longest_still_rounds = 5;

// Between fork and _exit only what is safe in a signal handler.
class Watchman {
 public:
  Watchman(int life, int node, std::uint8_t endpoint, std::vector<std::uint8_t>& no_force,
           ForceWatch& watch) noexcept
      : life_{life}, node_{node}, endpoint_{endpoint}, no_force_{no_force}, watch_{watch} {}

  [[noreturn]] void stand() noexcept {
    for (const int signal : std::array{SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE}) {
      struct sigaction ignored {};
      ignored.sa_handler = SIG_IGN;
      sigaction(signal, &ignored, nullptr);
    }
    while (lives_on()) {
      look();
      watch_.complete_round();
    }
    say_no_force();
    _exit(0);
  }

 private:
  // Waits for a round's time.
  bool lives_on() const noexcept {
    pollfd waiting{life_, POLLIN, 0};
    if (poll(&waiting, 1, round_ms) <= 0) {
      return true;
    }
    char byte = 0;
    return read(life_, &byte, 1) != 0;
  }
  void look() noexcept {
    const std::uint64_t beats = watch_.beats();
    still_rounds_ = watch_.is_on() && beats == beats_ ? still_rounds_ + 1 : 0;
    beats_ = beats;
    if (still_rounds_ == longest_still_rounds) {
      watch_.act();  // first: whoever wakes must find it before sending anything
      say_no_force();
    }
  }
  void say_no_force() noexcept {
    for (int i = 0; i < times_no_force_is_said; ++i) {
      usbdevfs_bulktransfer packet{endpoint_, static_cast<unsigned>(no_force_.size()), time_out_ms,
                                   no_force_.data()};
      ioctl(node_, USBDEVFS_BULK, &packet);  // NOLINT(cppcoreguidelines-pro-type-vararg)
    }
  }

  int life_;
  int node_;
  std::uint8_t endpoint_;
  std::vector<std::uint8_t>& no_force_;
  ForceWatch& watch_;
  std::uint64_t beats_{0};
  int still_rounds_{0};
};
}  // namespace

void Guardian::Unmap::operator()(ForceWatch* watch) const noexcept {
  munmap(watch, sizeof(ForceWatch));
}

std::unique_ptr<ForceWatch, Guardian::Unmap> Guardian::shared_watch() {
  void* const memory =
      mmap(nullptr, sizeof(ForceWatch), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) {  // NOLINT(cppcoreguidelines-pro-type-cstyle-cast): the C library's
    throw DeviceError{"the guardian of the device has no memory"};
  }
  return std::unique_ptr<ForceWatch, Unmap>{std::construct_at(static_cast<ForceWatch*>(memory))};
}
Guardian::Guardian(const UsbNode& node, std::uint8_t out_endpoint,
                   std::vector<std::uint8_t> no_force)
    : watch_{shared_watch()} {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw DeviceError{"the guardian of the device has no pipe"};
  }
  child_ = fork();
  if (child_ == 0) {
    setsid();  // Ctrl-C at the terminal is not for it
    close(ends[1]);
    Watchman{ends[0], node.descriptor(), out_endpoint, no_force, *watch_}.stand();
  }
  close(ends[0]);
  life_ = ends[1];
  if (child_ < 0) {
    close(life_);
    throw DeviceError{"the guardian of the device cannot be started"};
  }
}

Guardian::~Guardian() {
  close(life_);
  int status = 0;
  while (waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
}
}  // namespace tapstudy::device
