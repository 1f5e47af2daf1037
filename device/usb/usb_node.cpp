#include "device/usb/usb_node.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <libusb.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
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

std::vector<UsbListing> usb_devices() {
  libusb_context* raw = nullptr;
  if (const int error = libusb_init(&raw); error != LIBUSB_SUCCESS) {
    throw DeviceError{
        fmt::format("USB: this machine's devices cannot be listed: {}", libusb_strerror(error))};
  }
  const std::unique_ptr<libusb_context, decltype(&libusb_exit)> context{raw, libusb_exit};
  libusb_device** devices = nullptr;
  const ssize_t count = libusb_get_device_list(context.get(), &devices);
  std::vector<UsbListing> found;
  for (ssize_t i = 0; i < count; ++i) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(devices[i], &descriptor) != LIBUSB_SUCCESS) {
      continue;
    }
    const std::string node =
        fmt::format("/dev/bus/usb/{:03}/{:03}", libusb_get_bus_number(devices[i]),
                    libusb_get_device_address(devices[i]));
    found.push_back(
        {descriptor.idVendor, descriptor.idProduct, node, access(node.c_str(), R_OK | W_OK) == 0});
  }
  if (devices != nullptr) {
    libusb_free_device_list(devices, 1);
  }
  return found;
}
}  // namespace tapstudy::device
