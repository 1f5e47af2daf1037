#include "device/relay/serial_port.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "device/device.hpp"
namespace tapstudy::device {
bool set_up_serial_port(int descriptor) {
  termios modes{};
  if (tcgetattr(descriptor, &modes) != 0) {
    return false;
  }
  cfmakeraw(&modes);
  modes.c_cflag |= static_cast<tcflag_t>(CLOCAL);
  modes.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS | CSTOPB | HUPCL);
  cfsetspeed(&modes, B115200);
  return tcsetattr(descriptor, TCSANOW, &modes) == 0;
}

namespace {
DeviceError refusal(const std::string& port, const std::string& why) {
  return DeviceError{fmt::format("relay: '{}' {}", port, why)};
}
}  // namespace

DeadManRelay::DeadManRelay(const std::string& port)
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the C library's own
    : descriptor_{open(port.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)} {
  if (descriptor_ < 0) {
    throw refusal(port, fmt::format("cannot be opened: {}", std::strerror(errno)));
  }
  if (!set_up_serial_port(descriptor_)) {
    close(descriptor_);
    throw refusal(port, "is not a serial port");
  }
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    close(descriptor_);
    throw refusal(port, "is in use by another session");
  }
}

DeadManRelay::~DeadManRelay() {
  close(descriptor_);
}
}  // namespace tapstudy::device
