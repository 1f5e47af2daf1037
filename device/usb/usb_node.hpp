#pragma once
#include <cstdint>
#include <string>
#include <vector>
namespace tapstudy::device {
// A device that is plugged in.
struct UsbListing {
  std::uint16_t vendor{};
  std::uint16_t product{};
  std::string node;  // /dev/bus/usb/BBB/DDD
  bool may_open{};
};

// Throws DeviceError if the machine's USB cannot be listed.
std::vector<UsbListing> usb_devices();

// The open device node; closed on destruction. Separate from the library that drives it, so that a
// second process can hold it as well.
class UsbNode {
 public:
  // Throws DeviceError, with instructions if permission is denied.
  explicit UsbNode(const std::string& node);
  // Takes over a descriptor that is open already.
  explicit UsbNode(int descriptor) noexcept : descriptor_{descriptor} {}
  ~UsbNode();
  UsbNode(UsbNode&& other) noexcept;
  UsbNode(const UsbNode& other) = delete;
  UsbNode& operator=(const UsbNode& other) = delete;
  UsbNode& operator=(UsbNode&& other) = delete;
  int descriptor() const noexcept { return descriptor_; }

 private:
  int descriptor_;
};
}  // namespace tapstudy::device
