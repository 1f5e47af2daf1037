#include "device/usb/guardian.hpp"

#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>

#include "device/device.hpp"
namespace tapstudy::device {
namespace {
constexpr unsigned time_out_ms = 100;

// Between fork and _exit only what is safe in a signal handler.
[[noreturn]] void watch(int life, int node, std::uint8_t endpoint,
                        std::vector<std::uint8_t>& no_force) {
  for (const int signal : std::array{SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE}) {
    struct sigaction ignored {};
    ignored.sa_handler = SIG_IGN;
    sigaction(signal, &ignored, nullptr);
  }
  char byte = 0;
  ssize_t count = 0;
  do {
    count = read(life, &byte, 1);
  } while (count > 0 || (count < 0 && errno == EINTR));
  for (int i = 0; i < times_no_force_is_said; ++i) {
    usbdevfs_bulktransfer packet{endpoint, static_cast<unsigned>(no_force.size()), time_out_ms,
                                 no_force.data()};
    ioctl(node, USBDEVFS_BULK, &packet);  // NOLINT(cppcoreguidelines-pro-type-vararg)
  }
  _exit(0);
}
}  // namespace

Guardian::Guardian(const UsbNode& node, std::uint8_t out_endpoint,
                   std::vector<std::uint8_t> no_force) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw DeviceError{"the guardian of the device has no pipe"};
  }
  child_ = fork();
  if (child_ == 0) {
    setsid();  // Ctrl-C at the terminal is not for it
    close(ends[1]);
    watch(ends[0], node.descriptor(), out_endpoint, no_force);
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
