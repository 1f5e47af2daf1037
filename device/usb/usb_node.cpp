#include "device/usb/usb_node.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "device/device.hpp"
namespace tapstudy::device {
// NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the C library's own
UsbNode::UsbNode(const std::string& node) : descriptor_{open(node.c_str(), O_RDWR | O_CLOEXEC)} {
  if (descriptor_ >= 0) {
    return;
  }
  if (errno == EACCES || errno == EPERM) {
    throw DeviceError{fmt::format(
        "{}: no permission (copy device/udev/70-tapstudy.rules to /etc/udev/rules.d, run "
        "`udevadm control --reload`, and plug the device in again)",
        node)};
  }
  throw DeviceError{fmt::format("{}: cannot be opened: {}", node, std::strerror(errno))};
}

UsbNode::~UsbNode() {
  if (descriptor_ >= 0) {
    close(descriptor_);
  }
}

UsbNode::UsbNode(UsbNode&& other) noexcept : descriptor_{std::exchange(other.descriptor_, -1)} {}
}  // namespace tapstudy::device
